#pragma once

#include "diagnosis/bank/runner.h"
#include "diagnosis/inference/judgement.h"

namespace pendular::diagnosis {

/// What fresh runs need to know.
struct RepairInputs {
  const Experiment& experiment;
  const BankPlan& plan;
  const Problem& problem;
  MemberPackings& packings;
  MakeRuns make_runs;
};

/// The explanation whose effects are added: the most probable one; where that is unknown, the most probable
/// of the set that names an effect. Null where none does.
const Explanation* to_add(const Diagnosis& diagnosis);

/// How far the explanation to_add() closes the gap, and how far two controls do: the polymer's modulus
/// retuned freely, and the most probable effect outside the ambiguity set. Magnitudes are fitted by the
/// emulator; the figures are from fresh runs, on members that the bank does not have, of the specimen alone:
/// what instruments do is read into them, strains as truly_strained() says. Both figures are of the
/// same features, those that can be withheld: each test in turn, or where there is one test only each of its
/// observations; of all where there is one observation. `fitted`: with the magnitude that all observations
/// give. `withheld`: with the magnitude that the others give. Fills shrinkage, controls, overlays, warnings
/// and ledger. Nothing is run where there is none: the gap stays as it is.
void measure_shrinkage(const RepairInputs& inputs, Diagnosis& diagnosis);

/// What changes that are known to be true close on the same features. Books its runs in the ledger.
Shrinkage shrinkage_by(const RepairInputs& inputs, const Changes& changes, Diagnosis& diagnosis);

/// Fraction of a gap that is gone, with the interval that the features' noise leaves (seeded draws). There is
/// nothing to close where noise alone leaves a gap as large with a probability of 5 % and more: a fraction of
/// that would be one of the noise.
Shrinkage shrinkage_of(const Gap& before, const Eigen::VectorXd& after);

}  // namespace pendular::diagnosis
