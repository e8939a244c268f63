#pragma once

#include <functional>
#include <string>

#include "diagnosis/bank/runner.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/inference/judgement.h"

namespace pendular::diagnosis {

/// What is run beside the bank, and who hears of it.
struct Scope {
  bool fresh_runs = true;  ///< without, nothing is said of how far the gap shrinks, nor of further scans
  bool plan = false;       ///< of all conditions that the bank lacks, to assess further measurements
  /// Gets cause_of(), before anything of this is run.
  std::function<void(const std::string&)> say_cause = {};
};

/// Where an experiment and its simulation part, which effect causes it, how far it shrinks once that is
/// added, and what to measure next. `plan` is plan_bank()'s; runs are made by `make_runs`. BadInput where the
/// observations show nothing that can be compared; ComputationFailed where no baseline could be simulated.
Diagnosis diagnose(const Experiment& experiment, BankPlan plan, const fs::path& beads_folder,
                   const MakeRuns& make_runs, const Rules& rules = {}, const Scope& scope = {});

/// How far changes that are known to be true close the gap, as the shrinkage of a diagnosis measures it
/// (shrinkage_by()).
Shrinkage closed_by(const Experiment& experiment, const BankPlan& plan, const fs::path& beads_folder,
                    const MakeRuns& make_runs, const Changes& changes);

}  // namespace pendular::diagnosis
