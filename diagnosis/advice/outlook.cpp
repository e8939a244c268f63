#include "diagnosis/advice/outlook.h"

#include <algorithm>
#include <cmath>

namespace pendular::diagnosis {
namespace {

constexpr double kRuledOut = 1e-12;  // probability of what a sure measurement rules out

double entropy_of(const std::vector<Hypothesis>& said) {
  double bits = 0.0;
  for (const auto& h : said)
    if (h.probability > 0.0) bits -= h.probability * std::log2(h.probability);
  return bits;
}

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Which of some effects an explanation is made of.
std::set<std::string> found_in(const Hypothesis& h, const std::set<std::string>& effects) {
  std::set<std::string> found;
  for (const auto& effect : effects)
    if (h.id == effect || h.id.starts_with(effect + "+") || h.id.ends_with("+" + effect))
      found.insert(effect);
  return found;
}

}  // namespace

Outlook outlook_of(const std::vector<Replayed>& replayed, double confidence,
                   const std::function<double(const Replayed&)>& weight) {
  Outlook outlook;
  const Promise promise = promise_of(replayed, confidence);
  if (promise.cases == 0) return outlook;
  outlook.cases = promise.cases, outlook.effects = promise.effects;
  double sum = 0.0;
  for (const auto& one : replayed) {
    const double w = one.truth.size() < 2 ? weight(one) : 0.0;
    if (w <= 0.0) continue;
    const auto said = corrected(one.said, promise.of_replayed);
    const auto set = set_of(said, promise.of_replayed);
    sum += w;
    outlook.set_size += w * static_cast<double>(set.ids.size());
    outlook.entropy += w * entropy_of(said);
    outlook.settled += w * (set.ids.size() == 1 && holds(set.ids, truth_of(one)));
  }
  if (sum > 0.0) outlook.set_size /= sum, outlook.entropy /= sum, outlook.settled /= sum;
  return outlook;
}

std::vector<Replayed> knowing(std::vector<Replayed> replayed, const std::set<std::string>& effects) {
  for (auto& one : replayed) {
    std::set<std::string> there;
    for (const auto& [id, theta] : one.truth)
      if (effects.contains(id)) there.insert(id);
    // What is not in the library is not any of them.
    if (!there.empty()) std::erase_if(one.said, [](const Hypothesis& h) { return h.id == kUnknown; });
    double sum = 0.0;
    for (auto& h : one.said) {
      if (found_in(h, effects) != there) h.probability *= kRuledOut, h.log_evidence += std::log(kRuledOut);
      sum += h.probability;
    }
    for (auto& h : one.said) h.probability /= sum;
    std::stable_sort(one.said.begin(), one.said.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
  }
  return replayed;
}

}  // namespace pendular::diagnosis
