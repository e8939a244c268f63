#include "diagnosis/advice/planning.h"

#include "diagnosis/bank/bank_tests.h"

namespace pendular::diagnosis {

NextSteps plan_experiments(const Experiment& planned, const BankPlan& plan, const fs::path& beads_folder,
                           const MakeRuns& make_runs, const std::set<std::string>& about, const Rules& rules,
                           std::vector<LedgerRow>& ledger) {
  MemberPackings packings(beads_folder);
  BankTests bank(make_runs, ledger);
  bank.make("bank", plan);
  return next_steps(
      {planned, plan, bank.tests(), packings, &make_runs, kAnyStrain, rules.priors, rules.confidence, 0},
      question_before(plan, about), ledger);
}

}  // namespace pendular::diagnosis
