#include "diagnosis/runner.h"

#include <fmt/format.h>

namespace pendular::diagnosis {

std::optional<SimulatedTest> read_outcome(const sweep::RunOutcome& outcome, std::size_t condition,
                                          const std::string& purpose, std::vector<LedgerRow>& ledger) {
  ledger.push_back({outcome.hash, purpose, sweep::to_string(outcome.status), outcome.message, condition});
  if (outcome.status != sweep::RunStatus::done) return std::nullopt;
  return read_simulated_test(outcome.folder);
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
