#pragma once

#include <optional>

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/drawn.h"

namespace pendular::diagnosis_report {

/// The gap before and after, fitted and withheld, beside the controls. Nothing where no repaired run was
/// made.
std::optional<Drawn> shrinkage_figure(const diagnosis::Diagnosis& diagnosis);

/// Further measurements, what they are expected to leave, and their cost. Nothing where none is assessed.
std::optional<Drawn> next_figure(const diagnosis::NextSteps& steps);

}  // namespace pendular::diagnosis_report
