#pragma once

#include <optional>

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/drawn.h"
#include "viz/display.h"

namespace pendular::diagnosis_report {

/// The gap before and after, fitted and withheld, beside the controls. Nothing where no repaired run was
/// made.
std::optional<Drawn> shrinkage_figure(const viz::Display& display, const diagnosis::Diagnosis& diagnosis);

/// Further measurements and how probable it is that they settle the question. Nothing where there are none.
std::optional<Drawn> next_figure(const viz::Display& display, const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
