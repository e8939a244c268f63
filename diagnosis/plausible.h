#pragma once

#include "diagnosis/experiment.h"

namespace pendular::diagnosis {

/// Refuses what can only be a wrong unit or a wrong column: strain in per cent, stress off by thousands
/// against what the polymer's modulus allows, W in per cent, negative uncertainties. What is odd but usable
/// (uncertainties of zero, which count as not given) becomes one of the experiment's warnings. BadInput names
/// file and column, what was found and what was expected.
void check_plausible(Experiment& experiment, Observation& observation);

}  // namespace pendular::diagnosis
