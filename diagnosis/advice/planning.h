#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/inference/judgement.h"

namespace pendular::diagnosis {

/// What measurements are expected to tell before any is made: of all effects, or of those of `about` alone.
/// `planned`: planned_experiment(); `plan`: its bank. ComputationFailed where no baseline could be simulated.
NextSteps plan_experiments(const Experiment& planned, const BankPlan& plan, const fs::path& beads_folder,
                           const MakeRuns& make_runs, const std::set<std::string>& about, const Rules& rules,
                           std::vector<LedgerRow>& ledger);

}  // namespace pendular::diagnosis
