#include "diagnosis/problem.h"

#include "diagnosis/design.h"

namespace pendular::diagnosis {

Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests) {
  Problem problem;
  const auto [read_plan, read_tests] = with_readings(plan, tests);
  const auto learn = [&](Level level) {
    const BankFeatures features(level, experiment, read_plan, read_tests);
    return compare(experiment, read_plan, features.design(problem.warnings));
  };
  problem.landmarks = learn(Level::landmarks);
  problem.readings = learn(Level::readings);
  return problem;
}

}  // namespace pendular::diagnosis
