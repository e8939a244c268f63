#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/drawn.h"

namespace pendular::diagnosis_report {

/// Where the gap lies: z of every feature as a map of observations and features, and as bars beside each
/// feature's share of the gap. None where there are no features.
std::vector<Drawn> gap_figures(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
