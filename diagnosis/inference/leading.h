#pragma once

#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/inference/comparison.h"
#include "diagnosis/inference/evidence.h"

namespace pendular::diagnosis {

/// The explanations that a bank knows, most probable first: `unknown` has no probability here, since before
/// pairs were run what they do looks unknown.
std::vector<Hypothesis> known_explanations(const Comparison& readings, Priors priors);

/// Further points of the bank where it matters: pairs of effects that might explain the gap, run together
/// near their fitted magnitudes, and leading single effects where the bank has none near theirs. On members
/// in turn; magnitudes are rounded, so that experiments on one specimen share these runs. None where nothing
/// new leads, or where the budget of runs is spent.
std::vector<DesignPoint> leading_points(const std::vector<Hypothesis>& known, const BankPlan& plan);

/// Runs of what leads where it fits best, believed inputs included (DesignPoint::at_fit): responses to an
/// effect and to what is believed are learnt apart, and together they are not always their sum. None where
/// one effect or none has all but the whole probability, pairs that were not run counted, and leaves no more
/// than the noise; where all that leads was run so, or where the budget of runs is spent.
std::vector<DesignPoint> fitted_points(const Comparison& readings, std::vector<Hypothesis> known,
                                       const BankPlan& plan);

}  // namespace pendular::diagnosis
