#pragma once

#include <string>
#include <vector>

#include "diagnosis/bank.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/emulator.h"
#include "diagnosis/feature_values.h"

namespace pendular::diagnosis {

/// What is to be explained, and by what: all vectors in the order of `observed`.
struct Problem {
  ObservedFeatures observed;
  Eigen::VectorXd simulated;  ///< as believed, as features are compared
  Gap gap;
  std::vector<std::string> inputs;    ///< what the columns of gap.believed are responses to
  std::vector<Signature> signatures;  ///< of the effects
  std::vector<NoiseBudget> noise;
  std::vector<std::string> warnings;  ///< features that could not be used, and why
};

/// The names of columns of gap.believed that are no keys of the sample.
inline constexpr const char* kSimulationError = "stresses of the simulation";
inline constexpr const char* kBeadsError = "measured centres and diameters";

/// `tests`: of every point of the plan. Features that fewer than four of five runs show are left out, and of
/// more than twenty those that effects and inputs move least. BadInput where none is left.
Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests);

/// The gap of some features alone, in that order.
Gap part_of(const Gap& gap, const std::vector<std::size_t>& features);
std::vector<Signature> part_of(const std::vector<Signature>& signatures,
                               const std::vector<std::size_t>& features);

}  // namespace pendular::diagnosis
