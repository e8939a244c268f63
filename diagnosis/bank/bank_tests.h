#pragma once

#include <string>
#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/bank/runner.h"

namespace pendular::diagnosis {

/// The tests of a bank by its points, made as points are added.
class BankTests {
 public:
  BankTests(const MakeRuns& make_runs, std::vector<LedgerRow>& ledger)
      : make_runs_(make_runs), ledger_(ledger) {}

  /// Of every point of the plan that was made last.
  const std::vector<SimulatedTests>& tests() const { return tests_; }

  /// Makes the runs of the plan that were not made yet, under a name that progress shows. ComputationFailed
  /// where no specimen could be simulated as believed.
  void make(const std::string& name, const BankPlan& plan);

 private:
  const MakeRuns& make_runs_;
  std::vector<LedgerRow>& ledger_;
  std::vector<SimulatedTests> tests_;
  std::size_t made_ = 0;
};

}  // namespace pendular::diagnosis
