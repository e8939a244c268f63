#include "diagnosis/bank/runner.h"

#include <fmt/format.h>

#include "effects/list.h"

namespace pendular::diagnosis {

void book_run(const sweep::RunOutcome& outcome, std::size_t condition, const std::string& made_for,
              const Changes& changes, std::vector<LedgerRow>& ledger) {
  ledger.push_back({outcome.hash, made_for + purpose_of(changes), sweep::to_string(outcome.status),
                    outcome.message, condition});
}

std::shared_ptr<const SimulatedTest> read_run(const sweep::RunOutcome& outcome, const Changes& changes) {
  if (outcome.status != sweep::RunStatus::done) return nullptr;
  SimulatedTest test = read_simulated_test(outcome.folder);
  if (outcome.up_to) end_at(*outcome.up_to, test);
  for (const auto& effect : effects::all_effects()) {
    if (!effect.rows || !changes.contains(effect.id)) continue;
    (effect.reads_only() ? read_test : read_frames)(effect, changes.at(effect.id), test);
  }
  return std::make_shared<const SimulatedTest>(std::move(test));
}

std::string purpose_of(const Changes& changes) {
  if (changes.empty()) return "baseline";
  std::string words;
  for (const auto& [id, value] : changes) {
    if (!words.empty()) words += ", ";
    words += fmt::format("{} {:.4g}{}", id, value, id.find('.') == std::string::npos ? "" : " sd");
  }
  return words;
}

}  // namespace pendular::diagnosis
