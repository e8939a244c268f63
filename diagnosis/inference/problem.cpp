#include "diagnosis/inference/problem.h"

#include "diagnosis/bank/design.h"

namespace pendular::diagnosis {

Problem readings_of(const Experiment& experiment, const BankPlan& plan,
                    const std::vector<SimulatedTests>& tests) {
  Problem problem;
  const auto [read_plan, read_tests] = with_readings(plan, tests);
  problem.features.emplace(Level::readings, experiment, read_plan, read_tests);
  problem.design = problem.features->design(problem.warnings);
  problem.readings = compare(experiment, read_plan, problem.design);
  return problem;
}

void compare_anew(const Experiment& experiment, const BankPlan& plan, Problem& problem) {
  problem.readings = compare(experiment, plan, problem.design);
}

void add_landmarks(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests, Problem& problem) {
  const auto [read_plan, read_tests] = with_readings(plan, tests);
  const BankFeatures landmarks(Level::landmarks, experiment, read_plan, read_tests);
  std::vector<std::string> warnings;
  problem.landmarks = compare(experiment, read_plan, landmarks.design(warnings));
  problem.warnings.insert(problem.warnings.begin(), warnings.begin(), warnings.end());
}

Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests) {
  Problem problem = readings_of(experiment, plan, tests);
  add_landmarks(experiment, plan, tests, problem);
  return problem;
}

}  // namespace pendular::diagnosis
