#include "diagnosis/inference/correction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "diagnosis/inference/log_sum.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

bool is_pair(const Hypothesis& h) {
  return h.id == kOtherPairs || names_two(h.id);
}

/// Pairs that were not run, as one explanation: whichever is named, no run shows what it does.
std::vector<Hypothesis> with_others_as_one(std::vector<Hypothesis> said) {
  std::vector<Hypothesis> found;
  std::optional<Hypothesis> others;
  for (auto& h : said) {
    if (h.run) {
      found.push_back(std::move(h));
      continue;
    }
    if (!others || h.log_evidence > others->log_evidence)
      others = {kOtherPairs, h.log_evidence, others ? others->probability : 0.0, {}, h.chi_squared};
    others->probability += h.probability;
  }
  if (others) found.push_back(*std::move(others));
  return found;
}

/// What is unknown has beside each explanation, by how many replayed runs leave more.
void weigh_unknown_by_misfits(std::vector<Hypothesis>& said, const Correction& correction) {
  const auto& all = correction.misfits;
  double odds = 0.0;
  for (const auto& h : said) {
    if (h.id == kUnknown) continue;
    const auto more = all.end() - std::lower_bound(all.begin(), all.end(), h.chi_squared);
    const double share = (1.0 + static_cast<double>(more)) / (1.0 + static_cast<double>(all.size()));
    odds += h.probability * correction.misfit.odds * std::pow(share, -correction.misfit.power);
  }
  for (auto& h : said) h.probability = (h.id == kUnknown ? odds : h.probability) / (1.0 + odds);
}

/// What is unknown has beside all explanations, by what the observations show by themselves.
void add_odds_by_itself(double odds, std::vector<Hypothesis>& said) {
  const Hypothesis* unknown = said_of(said, kUnknown);
  if (!unknown || odds <= 0.0) return;
  const double whole = 1.0 + odds * (1.0 - unknown->probability);
  for (auto& h : said)
    h.probability = h.id == kUnknown ? 1.0 - (1.0 - h.probability) / whole : h.probability / whole;
}

}  // namespace

const Hypothesis* said_of(const std::vector<Hypothesis>& said, const std::string& id) {
  for (const auto& h : said)
    if (h.id == id) return &h;
  return nullptr;
}

std::vector<std::string> plainer(const std::string& id) {
  std::vector<std::string> ids = effects_in(id);
  if (ids.size() < 2) ids.clear();
  ids.emplace_back(kNone);
  return ids;
}

std::vector<std::string> not_told_from(const std::string& id, const std::map<std::string, double>& magnitudes,
                                       const Correction& correction) {
  std::vector<std::string> told, small;
  for (const auto& [effect, theta] : magnitudes)
    (correction.tells(effect, theta) ? told : small).push_back(effect);
  if (correction.untold_pairs.contains(id) || (told.empty() && !small.empty())) return plainer(id);
  return small.empty() ? small : told;
}

double beyond_plainer(const Hypothesis& pair, const std::vector<Hypothesis>& said) {
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& id : plainer(pair.id))
    if (const Hypothesis* one = said_of(said, id)) best = std::max(best, one->log_evidence);
  return std::isfinite(best) ? pair.log_evidence - best : 0.0;
}

double left_by_plain(const std::vector<Hypothesis>& said) {
  const Hypothesis* best = nullptr;
  for (const auto& h : said)
    if (h.id != kUnknown && !is_pair(h) && (!best || h.log_evidence > best->log_evidence)) best = &h;
  return best ? best->chi_squared : 0.0;
}

bool holds(const AmbiguitySet& set, const std::string& id) {
  return std::find(set.ids.begin(), set.ids.end(), id) != set.ids.end();
}

double upper_limit(const Hypothesis& effect, const Correction& correction) {
  const Magnitude& m = effect.magnitudes.front();
  const double wider = correction.of_all.of(effect.id) / correction.widening.of(effect.id);
  return correction.widening_of_limits *
         std::max(std::fabs(m.mean + wider * (m.interval_90.first - m.mean)),
                  std::fabs(m.mean + wider * (m.interval_90.second - m.mean)));
}

std::vector<Hypothesis> corrected(std::vector<Hypothesis> said, const Correction& correction) {
  const bool by_misfits = !correction.misfits.empty() && said_of(said, kUnknown);
  const double of_pairs = 1.0 / correction.temperature_of_pairs - 1.0 / correction.temperature;
  std::vector<double> logs;
  for (const auto& h : said) {
    logs.push_back(h.log_prior + h.log_evidence / correction.temperature);
    if (is_pair(h)) logs.back() += of_pairs * beyond_plainer(h, said);
    if (by_misfits && h.id == kUnknown) logs.back() = -std::numeric_limits<double>::infinity();
  }
  const double total = log_sum(logs);
  for (std::size_t k = 0; k < said.size(); ++k) {
    said[k].probability = std::exp(logs[k] - total);
    const double widening = correction.widening.of(said[k].id);
    for (Magnitude& m : said[k].magnitudes)
      m.interval_90 = {m.mean + widening * (m.interval_90.first - m.mean),
                       m.mean + widening * (m.interval_90.second - m.mean)};
  }
  if (by_misfits) weigh_unknown_by_misfits(said, correction);
  add_odds_by_itself(correction.odds_by_itself, said);
  said = with_others_as_one(std::move(said));
  std::stable_sort(said.begin(), said.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return said;
}

const char* why_unknown(const std::vector<Hypothesis>& said, const Correction& correction) {
  const Hypothesis* unknown = said_of(said, kUnknown);
  if (!unknown || (unknown->probability <= correction.gate && unknown != &said.front())) return nullptr;
  return correction.misfits.empty() ? "what is left is not like the noise"
                                    : "one effect leaves more than in most replayed runs";
}

const Hypothesis* stand_in(const Hypothesis& h, const std::vector<Hypothesis>& said,
                           const Correction& correction) {
  std::map<std::string, double> means;
  const auto ids = effects_in(h.id);
  for (std::size_t k = 0; k < h.magnitudes.size(); ++k) means[ids[k]] = h.magnitudes[k].mean;
  const bool single = ids.size() == 1;
  const double least = (single ? kThresholds.strong : 1.0) * h.probability;
  const double strong = correction.temperature * std::log(kThresholds.strong);
  const Hypothesis* best = nullptr;
  for (const auto& id : not_told_from(h.id, means, correction))
    if (const Hypothesis* other = said_of(said, id);
        other && other->probability > std::max(least, best ? best->probability : 0.0) &&
        (single || h.log_evidence - other->log_evidence < strong))
      best = other;
  return best;
}

const Hypothesis* stands_for(const Hypothesis& h, const AmbiguitySet& set,
                             const std::vector<Hypothesis>& said, const Correction& correction) {
  const Hypothesis* other = stand_in(h, said, correction);
  return other && !holds(set, h.id) && holds(set, other->id) ? other : nullptr;
}

AmbiguitySet set_of(const std::vector<Hypothesis>& said, const Correction& correction) {
  AmbiguitySet set;
  double known = 0.0;
  for (const auto& h : said)
    if (h.id != kUnknown && h.id != kOtherPairs) known += h.probability;
  const bool first = !said.empty() && said.front().id == kUnknown;
  if (first) set.ids.push_back(kUnknown);
  double held = 0.0;
  for (const auto& h : said) {
    if (h.id == kUnknown) continue;
    if (h.id == kOtherPairs) {
      if (&h == &said.front()) set.ids.push_back(h.id);
      continue;
    }
    const auto own = correction.levels.find(h.id);
    const double level = own == correction.levels.end() ? correction.level : own->second;
    const bool matters = h.probability >= kThresholds.least_in_set || &h == &said.front();
    if (held <= level && matters && !stand_in(h, said, correction)) set.ids.push_back(h.id);
    held += h.probability / known;
  }
  if (!first && said_of(said, kUnknown) && why_unknown(said, correction)) set.ids.push_back(kUnknown);
  for (const auto& h : said)
    if (holds(set, h.id) || stands_for(h, set, said, correction)) set.probability += h.probability;
  return set;
}

}  // namespace pendular::diagnosis
