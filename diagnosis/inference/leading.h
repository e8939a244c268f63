#pragma once

#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/inference/problem.h"

namespace pendular::diagnosis {

/// Further points of the bank where it matters: pairs of effects that might explain the gap, run together
/// near their fitted magnitudes, and leading single effects where the bank has none near theirs. On members
/// in turn; magnitudes are rounded, so that experiments on one specimen share these runs. None where nothing
/// new leads, or where the budget of runs is spent.
std::vector<DesignPoint> leading_points(const Problem& problem, const Priors& priors, const BankPlan& plan);

}  // namespace pendular::diagnosis
