#include "diagnosis/bank/bank_tests.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"

namespace pendular::diagnosis {

void BankTests::make(const std::string& name, const BankPlan& plan) {
  const auto outcomes = make_runs_(name, std::span(plan.requests).subspan(made_));
  tests_.resize(plan.points.size(), SimulatedTests(plan.conditions.size()));
  std::size_t baselines = 0;
  std::string why;
  for_blocks(outcomes.size(), 1, [&](std::size_t k, std::size_t) {
    const auto& [point, condition] = plan.runs[made_ + k];
    tests_[point][condition] = read_run(outcomes[k], plan.points[point].changes);
  });
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const auto& [point, condition] = plan.runs[made_ + k];
    const DesignPoint& of = plan.points[point];
    book_run(outcomes[k], condition, "", of.changes, ledger_);
    if (of.id.empty() && tests_[point][condition]) ++baselines;
    if (of.id.empty() && !tests_[point][condition]) why = outcomes[k].message;
  }
  if (made_ == 0 && baselines == 0 && !outcomes.empty())
    throw ComputationFailed(
        fmt::format("no specimen could be simulated as believed; the last one said: {}", why));
  made_ = plan.requests.size();
}

}  // namespace pendular::diagnosis
