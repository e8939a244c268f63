#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// "a+b".
bool is_pair(const std::string& id);

/// Whether an explanation, or an effect by itself, is among those that cannot be told apart.
bool in_ambiguity_set(const diagnosis::Diagnosis& diagnosis, const std::string& id);

/// Whether an effect is named by any of them.
bool is_suspect(const diagnosis::Diagnosis& diagnosis, const std::string& effect);

/// |θ| from which on an effect is told from none, below zero and above (Correction::told_from); not a number
/// where no run of that sign was replayed.
std::pair<double, double> told_from(const diagnosis::Diagnosis& diagnosis, const std::string& effect);

/// "observation: feature" for figures, the observation's name shortened where it is long.
std::string feature_label(const diagnosis::Feature& feature);

/// What a reader is shown: every single explanation and the pairs that matter, in their order; and what the
/// other pairs sum up to.
struct Shown {
  std::vector<diagnosis::Explanation> explanations;
  std::size_t other_pairs = 0;
  double other_probability = 0.0;
};
Shown shown_of(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
