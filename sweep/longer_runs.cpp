#include "sweep/longer_runs.h"

#include <map>
#include <set>
#include <utility>

namespace pendular::sweep {
namespace {

constexpr std::string_view kLastStrain = "\"compression.max_strain\": ";

/// The text of a request without the value of its last strain, and that value.
std::pair<std::string, double> without_last_strain(std::string text) {
  const std::size_t from = text.find(kLastStrain) + kLastStrain.size();
  std::size_t length = 0;
  const double strain = std::stod(text.substr(from), &length);
  text.erase(from, length);
  return {std::move(text), strain};
}

}  // namespace

std::vector<std::optional<std::string>> longer_runs(Store& store, std::span<const RunRequest> requests) {
  std::vector<std::optional<std::string>> found(requests.size());
  const auto finished = store.finished();
  std::set<std::string> done;
  for (const auto& [hash, text] : finished) done.insert(hash);
  std::map<std::pair<std::string, double>, std::string> runs;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    const std::string text = request_text(requests[k]);
    if (requests[k].keep_all || done.contains(sha256(text))) continue;
    if (runs.empty())
      for (const auto& [hash, of] : finished) runs.emplace(without_last_strain(of), hash);
    const auto wanted = without_last_strain(text);
    const auto next = runs.upper_bound(wanted);
    if (next != runs.end() && next->first.first == wanted.first) found[k] = next->second;
  }
  return found;
}

}  // namespace pendular::sweep
