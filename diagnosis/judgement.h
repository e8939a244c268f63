#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/problem.h"

namespace pendular::diagnosis {

/// Thresholds and priors, frozen on the development split (docs/blind.md).
struct Rules {
  Priors priors;
  double like_known_in_fields = 0.05;  ///< Priors::like_known where displacements were measured: hardly
  double in_set = 0.9;        ///< probability that an ambiguity set holds together
  double excluded = 0.01;     ///< of an effect by itself, below which it is excluded
  double separable = 9.0;     ///< Δ² below which two effects cannot be told apart
  double also_in_set = 0.05;  ///< probability from which an inseparable effect belongs to the set
  double poor_fit = 0.1;      ///< goodness of the best explanation below which `unknown` belongs to the set
};

/// Weighs every explanation of the gap and fills everything of a diagnosis that needs no further runs:
/// gap, noise, explanations, ambiguity set, goodness, signatures, separation, groups, pulls.
void judge(const Problem& problem, const Rules& rules, const BankPlan& plan, const Experiment& experiment,
           Diagnosis& diagnosis);

/// Best magnitudes of a hypothesis for the readings of some observations: a single effect or a pair by the ids
/// in `ids`. Means a posteriori; empty for none.
Changes fitted_changes(const Problem& problem, const std::vector<std::string>& ids,
                       const std::vector<std::size_t>& observations);

/// "a+b" → a, b; nothing for "none" and "unknown".
std::vector<std::string> effects_in(const std::string& id);

}  // namespace pendular::diagnosis
