#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"
#include "diagnosis/inference/problem.h"

namespace pendular::diagnosis {

/// Thresholds and priors, frozen on the development split (docs/blind.md).
struct Rules {
  Priors priors;
  double like_known_in_fields = 0.05;  ///< Priors::like_known where displacements were measured: hardly
  Misfit misfit_in_fields = {0.008, 1.6, 1.6};  ///< Priors::misfit likewise: replays leave what measured do
  double confidence = 0.95;                     ///< with which a set holds the truth, as the replay shows it
  double excluded = 0.01;                       ///< of an effect by itself, below which it is excluded
  double separable = 9.0;                       ///< Δ² from none below which an effect is hardly shown
  int draws = 1;                                ///< of each run that is replayed
};

/// Weighs every explanation of the gap and fills everything of a diagnosis that needs no further runs:
/// gap, noise, promise, explanations, ambiguity set, p-value, signatures, separation, groups, pulls. What it
/// promises is learnt from a replay where the problem has the features of its bank.
void judge(const Problem& problem, const Rules& rules, const BankPlan& plan, const Experiment& experiment,
           Diagnosis& diagnosis);

/// Magnitudes of a hypothesis for the readings of some observations: a single effect or a pair by the ids in
/// `ids`. Empty for none.
Magnitudes fitted_magnitudes(const Problem& problem, const std::vector<std::string>& ids,
                             const std::vector<std::size_t>& observations);

/// Observations whose strains are those of the specimen, by the readings that effects have.
std::set<std::size_t> truly_strained(const Comparison& comparison, const Magnitudes& magnitudes);

/// Means a posteriori.
Changes changes_of(const Magnitudes& magnitudes);

}  // namespace pendular::diagnosis
