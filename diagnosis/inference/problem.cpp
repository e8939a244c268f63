#include "diagnosis/inference/problem.h"

#include "diagnosis/bank/design.h"

namespace pendular::diagnosis {

Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests) {
  Problem problem;
  const auto [read_plan, read_tests] = with_readings(plan, tests);
  const BankFeatures landmarks(Level::landmarks, experiment, read_plan, read_tests);
  problem.landmarks = compare(experiment, read_plan, landmarks.design(problem.warnings));
  problem.features.emplace(Level::readings, experiment, read_plan, read_tests);
  problem.readings = compare(experiment, read_plan, problem.features->design(problem.warnings));
  return problem;
}

}  // namespace pendular::diagnosis
