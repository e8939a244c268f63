#pragma once

#include "diagnosis/judgement.h"
#include "diagnosis/runner.h"

namespace pendular::diagnosis {

/// What fresh runs need to know.
struct RepairShop {
  const Experiment& experiment;
  const BankPlan& plan;
  const Problem& problem;
  fs::path beads_folder;
  MakeRuns make_runs;
};

/// How far the best explanation closes the gap, and how far two controls do: the polymer's modulus retuned
/// freely, and the most probable effect outside the ambiguity set. Magnitudes are fitted by the emulator; the
/// figures are from fresh runs, on members that the bank does not have. `fitted`: all observations, with the
/// magnitude that all of them give. `withheld`: each test in turn (where there is one test only, each of its
/// observations) with the magnitude that the others give. Fills shrinkage, controls, overlays and ledger.
/// Nothing is run where the explanation is `none` or `unknown`: the gap stays as it is.
void measure_shrinkage(const RepairShop& shop, Diagnosis& diagnosis);

/// Fraction of a gap that is gone, with the interval that the features' noise leaves (seeded draws).
Shrinkage shrinkage_of(const Gap& before, const Eigen::VectorXd& after);

}  // namespace pendular::diagnosis
