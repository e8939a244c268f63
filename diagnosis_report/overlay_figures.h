#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/drawn.h"

namespace pendular::diagnosis_report {

/// Every observation as measured, as simulated with what is believed, and with the best explanation where
/// such runs were made: the band of the realisations, and how far it is from what was measured.
std::vector<Drawn> overlay_figures(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
