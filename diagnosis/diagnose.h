#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/judgement.h"
#include "diagnosis/runner.h"

namespace pendular::diagnosis {

/// Where an experiment and its simulation part, which effect causes it, how far it shrinks once that is
/// added, and what to measure next. `plan` is plan_bank()'s; runs are made by `make_runs`. BadInput where the
/// observations show nothing that can be compared; ComputationFailed where no baseline could be simulated.
/// Without fresh runs nothing is said of how far the gap shrinks.
Diagnosis diagnose(const Experiment& experiment, BankPlan plan, const fs::path& beads_folder,
                   const MakeRuns& make_runs, const Rules& rules = {}, bool fresh_runs = true);

}  // namespace pendular::diagnosis
