#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/bank/runner.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/inference/evidence.h"

namespace pendular::diagnosis {

/// What is in question, and how likely each answer is.
struct Question {
  std::set<std::string> effects;                ///< the library that is left
  std::map<std::string, double> probabilities;  ///< of these and of "none", up to a factor
  std::map<std::string, Magnitude> magnitudes;  ///< where something is known of them
};

/// The effects that lead or are in the set, by their probabilities and magnitudes a posteriori.
Question question_after(const Diagnosis& diagnosis);

/// Whether one explanation is left that is more likely than not and, where that is none, no effect is in
/// question that none stands for.
bool is_settled(const Diagnosis& diagnosis);

/// Every effect of the plan alike, or those of `about` alone where it has any, and none.
Question question_before(const BankPlan& plan, const std::set<std::string>& about);

/// Platen strain of tests of any length.
inline constexpr double kAnyStrain = 1.0;

/// A bank, and what may be done to it.
struct BankInHand {
  const Experiment& experiment;
  const BankPlan& plan;
  const std::vector<SimulatedTests>& tests;  ///< of every point of the plan
  MemberPackings& packings;
  const MakeRuns* make_runs;  ///< nullptr: none is made
  double farthest;            ///< platen strain to which tests that the bank lacks are run
  Priors priors;
  double confidence = 0.95;
  std::size_t measured = 0;  ///< observations of the experiment that were made; the others are planned
};

/// Every run of a bank without an effect or with one of some, diagnosed with all that an experiment on the
/// same specimens has. Conditions that the bank lacks are run, and booked in the ledger under a name, where
/// that is allowed; empty where they are not.
std::vector<Replayed> replayed_with(const BankInHand& bank, const Experiment& experiment,
                                    const std::set<std::string>& effects, const std::string& name,
                                    std::vector<LedgerRow>& ledger);

/// What further measurements are expected to bring: each is added to the experiment as it would be planned,
/// runs of the bank are taken for the truth, and diagnosed with it (replay()). Conditions that the bank lacks
/// are run for what is in question, and booked in the ledger, where that is allowed. A measurement that is
/// not of a specimen finds its effects or rules them out: what it gains is of their probabilities as they
/// are. Best value first: the probability that it settles beyond that now, and a tenth of the bits that it
/// gains, over its cost and that of another round, two compression tests.
NextSteps next_steps(const BankInHand& bank, const Question& question, std::vector<LedgerRow>& ledger);

}  // namespace pendular::diagnosis
