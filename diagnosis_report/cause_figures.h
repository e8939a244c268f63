#pragma once

#include <optional>
#include <vector>

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/drawn.h"

namespace pendular::diagnosis_report {

/// Probabilities of all explanations. Nothing where there are none; likewise below.
std::optional<Drawn> hypothesis_figure(const diagnosis::Diagnosis& diagnosis);

/// What each effect does to each feature; and how far effects are from each other.
std::optional<Drawn> signature_figure(const diagnosis::Diagnosis& diagnosis);
std::optional<Drawn> separation_figure(const diagnosis::Diagnosis& diagnosis);

/// The magnitude that each observation by itself asks for, a figure for every effect that is suspected.
std::vector<Drawn> magnitude_figures(const diagnosis::Diagnosis& diagnosis);

/// Believed inputs under the best explanation.
std::optional<Drawn> pull_figure(const diagnosis::Diagnosis& diagnosis);

/// What the best magnitudes of each explanation leave.
std::optional<Drawn> chi_squared_figure(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
