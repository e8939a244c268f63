#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/comparison.h"

namespace pendular::diagnosis {

/// What is to be explained, and by what.
struct Problem {
  Comparison landmarks;                       ///< for words, figures and repair
  Comparison readings;                        ///< for the evidence
  std::optional<BankFeatures> features = {};  ///< that the readings were learnt from
  Design design = {};                         ///< of these
  std::vector<std::string> warnings = {};     ///< features that could not be used, and why
};

/// `tests`: of every point of the plan.
Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests);

/// The same runs, where the plan knows more of the law (BankPlan::as_stated).
void compare_anew(const Experiment& experiment, const BankPlan& plan, Problem& problem);

/// Its readings alone, which are all that the evidence needs, and what is for words besides.
Problem readings_of(const Experiment& experiment, const BankPlan& plan,
                    const std::vector<SimulatedTests>& tests);
void add_landmarks(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests, Problem& problem);

}  // namespace pendular::diagnosis
