#pragma once

#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/bank/bank_tests.h"
#include "sweep/store.h"

namespace pendular::bench {

/// The first pass of a bank, and what of it a store has.
struct StoredBank {
  diagnosis::MemberPackings packings;
  diagnosis::BankPlan plan;
  std::vector<diagnosis::SimulatedTests> tests;
  std::vector<diagnosis::LedgerRow> ledger;

  StoredBank(const diagnosis::Experiment& experiment, const fs::path& store) : packings(store / "measured") {
    diagnosis::BankOptions options;
    options.runs = 0;
    plan = diagnosis::plan_bank(experiment, options, store / "measured");
    tests.resize(plan.points.size(), diagnosis::SimulatedTests(plan.conditions.size()));
    const sweep::Store runs(store);
    for (std::size_t k = 0; k < plan.runs.size(); ++k) {
      const auto& [point, condition] = plan.runs[k];
      const std::string hash = sweep::content_hash(plan.requests[k]);
      sweep::RunOutcome outcome;
      outcome.hash = hash, outcome.folder = runs.run_folder(hash);
      outcome.status =
          fs::exists(outcome.folder / "result.json") ? sweep::RunStatus::done : sweep::RunStatus::waiting;
      diagnosis::book_run(outcome, condition, "", plan.points[point].changes, ledger);
      tests[point][condition] = diagnosis::read_run(outcome, plan.points[point].changes);
    }
  }
};

}  // namespace pendular::bench
