#include "diagnosis/inference/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include "diagnosis/inference/log_sum.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr double kTemperatures[] = {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0};
constexpr double kLeastProbability = 1e-9;  // that a wrong answer is charged with
constexpr double kNoProbability = 1e-300;
constexpr double kMostForUnknown = 4.0, kStepForUnknown = 0.5;  // logarithms of evidence
constexpr std::size_t kLeastOutside = 12;  // runs from which the evidence of `unknown` is corrected
constexpr double kConfident = 0.9;         // probability of what is said without doubt
constexpr double kBins[] = {0.0, 0.4, 0.6, 0.8, 0.9, 1.0};
constexpr const char* kNone = "none";
constexpr const char* kUnknown = "unknown";

const Hypothesis* said_of(const std::vector<Hypothesis>& said, const std::string& id) {
  for (const auto& h : said)
    if (h.id == id) return &h;
  return nullptr;
}

/// What stands for an explanation that is not told from it: none for an effect; its effects and none for a
/// pair.
std::vector<std::string> plainer(const std::string& id) {
  std::vector<std::string> ids = effects_in(id);
  if (ids.size() < 2) ids.clear();
  ids.emplace_back(kNone);
  return ids;
}

/// The least value that ⌈(n+1) share⌉ of these do not exceed: of the n+1 to come as many, whatever their law.
double conformal(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  const auto rank = static_cast<std::size_t>(std::ceil((n + 1.0) * share));
  return values[std::min(values.size(), rank) - 1];
}

/// Probability that the known explanations before one have together, over that of all known.
double before(const std::vector<Hypothesis>& said, const std::string& id) {
  double sum = 0.0, all = 0.0;
  bool reached = false;
  for (const auto& h : said) {
    reached = reached || h.id == id;
    if (h.id == kUnknown) continue;
    all += h.probability;
    if (!reached) sum += h.probability;
  }
  return all > 0.0 ? sum / all : 0.0;
}

/// By how much an interval must be widened about its mean to hold a value.
double needed_widening(const Magnitude& magnitude, double theta) {
  const double room = theta > magnitude.mean ? magnitude.interval_90.second - magnitude.mean
                                             : magnitude.mean - magnitude.interval_90.first;
  return std::fabs(theta - magnitude.mean) / std::max(room, 1e-12);
}

std::vector<Hypothesis> tempered(const std::vector<Hypothesis>& said, const Correction& found) {
  Correction correction;
  correction.temperature = found.temperature, correction.for_unknown = found.for_unknown;
  correction.widening_of_others = 1.0;
  return corrected(said, correction);
}

using Cases = std::vector<const Replayed*>;

/// Replayed runs: those that an explanation of the library is right for, and those whose effect it lacks.
struct Learning {
  Cases known, outside;

  /// Of a run outside, where each known one has 1: together they have the prior share of `unknown`.
  double weight_outside() const {
    const double share = Priors{}.unknown;
    return share / (1.0 - share) * static_cast<double>(known.size()) / static_cast<double>(outside.size());
  }
};

/// What a run was said to be, as a correction changes it.
struct SaidLogs {
  std::vector<double> weights, evidences;  // logarithms
  std::optional<std::size_t> truth, unknown;

  explicit SaidLogs(const Replayed& one) {
    const std::string right = truth_of(one);
    for (std::size_t k = 0; k < one.said.size(); ++k) {
      weights.push_back(std::log(std::max(kNoProbability, one.said[k].probability)));
      evidences.push_back(one.said[k].log_evidence);
      if (one.said[k].id == right) truth = k;
      if (one.said[k].id == kUnknown) unknown = k;
    }
  }

  std::vector<double> corrected(double temperature, double for_unknown) const {
    std::vector<double> logs = weights;
    for (std::size_t k = 0; k < logs.size(); ++k) logs[k] += evidences[k] * (1.0 / temperature - 1.0);
    if (unknown) logs[*unknown] += for_unknown;
    return logs;
  }

  /// −ln of what the truth got.
  double loss(double temperature, double for_unknown) const {
    if (!truth) return -std::log(kLeastProbability);
    const auto logs = corrected(temperature, for_unknown);
    return std::min(-std::log(kLeastProbability), log_sum(logs) - logs[*truth]);
  }
};

/// The temperature, and what is added for `unknown`, of least loss.
void learn_probabilities(const Learning& cases, Correction& found) {
  const bool outside = cases.outside.size() >= kLeastOutside;
  std::vector<std::pair<SaidLogs, double>> weighed;
  for (const auto* one : cases.known) weighed.emplace_back(*one, 1.0);
  if (outside)
    for (const auto* one : cases.outside) weighed.emplace_back(*one, cases.weight_outside());
  double least = INFINITY;
  for (const double temperature : kTemperatures)
    for (double more = outside ? -kMostForUnknown : 0.0; more <= (outside ? kMostForUnknown : 0.0);
         more += kStepForUnknown) {
      double loss = 0.0;
      for (const auto& [said, weight] : weighed) loss += weight * said.loss(temperature, more);
      if (loss < least) least = loss, found.temperature = temperature, found.for_unknown = more;
    }
}

/// Whether a set holds an answer.
bool holds(const AmbiguitySet& set, const std::string& id) {
  return std::find(set.ids.begin(), set.ids.end(), id) != set.ids.end();
}

bool holds_any(const AmbiguitySet& set, const std::vector<std::string>& ids) {
  return std::any_of(ids.begin(), ids.end(), [&](const std::string& id) { return holds(set, id); });
}

/// Whether a set is right: it holds the truth, or what stands for it where the truth is unseen.
bool right(const AmbiguitySet& set, const std::string& truth, const Correction& correction) {
  return holds(set, truth) || (correction.unseen.contains(truth) && holds_any(set, plainer(truth)));
}

/// Truths in the order of the level that they need at the mean, split in two where the parts differ most; one
/// part where either would have too few runs.
std::vector<std::vector<std::string>> clusters_of(const std::map<std::string, std::vector<double>>& needed) {
  std::vector<std::pair<double, std::string>> order;
  double all = 0.0, runs = 0.0;
  for (const auto& [id, values] : needed) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0),
                 n = static_cast<double>(values.size());
    order.emplace_back(sum / n, id);
    all += sum, runs += n;
  }
  std::sort(order.begin(), order.end());
  double sum = 0.0, n = 0.0, most = 0.0;
  std::size_t split = order.size();
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const double here = static_cast<double>(needed.at(order[k].second).size());
    sum += here * order[k].first, n += here;
    const double apart = n * (runs - n) * std::pow(sum / n - (all - sum) / (runs - n), 2);
    if (std::min(n, runs - n) >= kThresholds.least_in_cluster && apart > most) most = apart, split = k + 1;
  }
  std::vector<std::vector<std::string>> clusters(split < order.size() ? 2 : 1);
  for (std::size_t k = 0; k < order.size(); ++k) clusters[k < split ? 0 : 1].push_back(order[k].second);
  return clusters;
}

/// The least levels at which sets hold their truth: in each cluster of truths nearly as often as asked for,
/// and in all together as often.
void learn_levels(const std::vector<std::vector<Hypothesis>>& said, const Cases& cases, double confidence,
                  Correction& found) {
  std::map<std::string, std::vector<double>> needed;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const std::string truth = truth_of(*cases[k]);
    double level = before(said[k], truth);
    if (found.unseen.contains(truth))
      for (const auto& id : plainer(truth)) level = std::min(level, before(said[k], id));
    needed[truth].push_back(level);
  }
  std::vector<double> beyond;  // levels that are needed where a cluster's own does not do
  found.levels.clear();
  for (const auto& cluster : clusters_of(needed)) {
    std::vector<double> values;
    for (const auto& id : cluster) values.insert(values.end(), needed[id].begin(), needed[id].end());
    const double own = conformal(values, confidence - kThresholds.less_in_cluster);
    for (const auto& id : cluster) found.levels[id] = own;
    for (const double value : values) beyond.push_back(value <= own ? 0.0 : value);
  }
  found.level = conformal(std::move(beyond), confidence);
  for (auto& [id, level] : found.levels) level = std::max(level, found.level);
}

/// Probability that of n runs at least so many are told apart by slips alone.
double by_slips(int told, int n) {
  double below = 0.0, term = std::pow(1.0 - kThresholds.by_slip, n);
  for (int k = 0; k < told; ++k) {
    below += term;
    term *= kThresholds.by_slip / (1.0 - kThresholds.by_slip) * static_cast<double>(n - k) /
            static_cast<double>(k + 1);
  }
  return 1.0 - below;
}

/// Effects whose runs are told from none, and pairs whose runs are told from their effects and none, no more
/// often than slips explain.
std::set<std::string> unseen_in(const std::vector<std::vector<Hypothesis>>& said, const Cases& cases,
                                const Correction& correction) {
  std::map<std::string, std::pair<int, int>> told;  // runs told apart, and all
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const std::string truth = truth_of(*cases[k]);
    auto& [apart, all] = told[truth];
    apart += !holds_any(set_of(said[k], correction), plainer(truth)), ++all;
  }
  std::set<std::string> unseen;
  for (const auto& [id, counts] : told)
    if (id != kNone && by_slips(counts.first, counts.second) > kThresholds.by_slip) unseen.insert(id);
  return unseen;
}

/// Widenings of intervals of θ and of upper limits.
void learn_magnitudes(const Cases& cases, Correction& found) {
  std::vector<double> all, limits;
  std::map<std::string, std::vector<double>> widenings;
  for (const auto* one : cases) {
    if (one->truth.size() != 1) continue;
    const Hypothesis* truth = said_of(one->said, truth_of(*one));
    if (!truth) continue;
    all.push_back(needed_widening(truth->magnitudes.front(), one->truth.begin()->second));
    widenings[truth->id].push_back(all.back());
  }
  if (all.empty()) return;
  found.widening_of_others = std::max(1.0, conformal(std::move(all), kThresholds.of_theta));
  for (auto& [id, values] : widenings) {
    const double n = static_cast<double>(values.size()),
                 own = std::max(0.3, conformal(std::move(values), kThresholds.of_theta));
    found.widening[id] = std::max(
        1.0, std::exp((n * std::log(own) + kThresholds.worth_of_all * std::log(found.widening_of_others)) /
                      (n + kThresholds.worth_of_all)));
  }
  found.widening_of_limits = 1.0;
  for (const auto* one : cases) {
    if (one->truth.size() != 1) continue;
    const auto said = corrected(one->said, found);
    if (const Hypothesis* truth = said_of(said, truth_of(*one)))
      limits.push_back(std::fabs(one->truth.begin()->second) /
                       std::max(1e-12, upper_limit(truth->magnitudes.front(), found)));
  }
  found.widening_of_limits = std::max(1.0, conformal(std::move(limits), kThresholds.of_limits));
}

Correction learn(const Learning& learning, double confidence) {
  Correction found;
  learn_probabilities(learning, found);
  const Cases& cases = learning.known;
  std::vector<std::vector<Hypothesis>> said;
  std::vector<double> alarms;
  for (const auto* one : cases) {
    said.push_back(tempered(one->said, found));
    alarms.push_back(said_of(said.back(), kUnknown)->probability);
  }
  found.gate = conformal(std::move(alarms), 1.0 - kThresholds.false_alarms);
  learn_levels(said, cases, confidence, found);
  found.unseen = unseen_in(said, cases, found);
  learn_levels(said, cases, confidence, found);
  learn_magnitudes(cases, found);
  return found;
}

/// Of the most probable explanations of replayed runs, by their probability.
class Bins {
 public:
  void count(const std::vector<Hypothesis>& said, const std::string& truth, double weight) {
    const double top = said.front().probability;
    const auto at =
        static_cast<std::size_t>(std::upper_bound(kBins + 1, std::end(kBins) - 1, top) - kBins - 1);
    bins_[at].said += weight * top, bins_[at].came_true += weight * (said.front().id == truth);
    ++bins_[at].cases, weights_[at] += weight;
  }

  std::vector<Reliability> reliability() const {
    std::vector<Reliability> found;
    for (std::size_t k = 0; k < bins_.size(); ++k)
      if (bins_[k].cases > 0)
        found.push_back({bins_[k].said / weights_[k], bins_[k].came_true / weights_[k], bins_[k].cases});
    return found;
  }

 private:
  std::array<Reliability, std::size(kBins) - 1> bins_;
  std::array<double, std::size(kBins) - 1> weights_ = {};
};

/// Adds what a run whose effect was left out shows of corrections that did not see its member.
void count_outside(const Replayed& one, const Correction& correction, double weight, Promise& promise,
                   Bins& bins) {
  const auto said = corrected(one.said, correction);
  ++promise.outside.cases;
  promise.outside.flagged += holds(set_of(said, correction), kUnknown);
  promise.outside.misnamed += said.front().id != kUnknown && said.front().probability > kConfident;
  bins.count(said, kUnknown, weight);
}

/// Adds what one replayed run shows of corrections that did not see its member.
void count(const Replayed& one, const Correction& correction, Promise& promise, Bins& bins,
           double& magnitudes) {
  const auto said = corrected(one.said, correction);
  const AmbiguitySet set = set_of(said, correction);
  const std::string truth = truth_of(one);
  promise.in_set += right(set, truth, correction);
  promise.set_size += static_cast<double>(set.ids.size());
  promise.false_alarms += holds(set, kUnknown);
  bins.count(said, truth, 1.0);
  if (one.truth.empty()) return;
  EffectReplay& effect = promise.effects[truth];
  ++effect.cases;
  effect.told_from_none += !holds(set, kNone);
  effect.first += said.front().id == truth;
  effect.in_set += right(set, truth, correction);
  const Hypothesis* named = said_of(said, truth);
  if (!named || one.truth.size() > 1) return;
  const auto& [low, high] = named->magnitudes.front().interval_90;
  const double theta = one.truth.begin()->second;
  promise.theta_held += low <= theta && theta <= high, magnitudes += 1.0;
  promise.limits_held += std::fabs(theta) <= upper_limit(named->magnitudes.front(), correction);
}

/// Whether something stands in the set for an unseen explanation: none, or an effect of a pair that is more
/// probable than the pair.
bool stood_for(const Hypothesis& h, const std::vector<Hypothesis>& said, const AmbiguitySet& set,
               const Correction& correction) {
  if (!correction.unseen.contains(h.id)) return false;
  for (const auto& id : plainer(h.id)) {
    const Hypothesis* other = said_of(said, id);
    const bool ranks = effects_in(h.id).size() < 2 || (other && other->probability > h.probability);
    if (holds(set, id) && ranks) return true;
  }
  return false;
}

}  // namespace

std::string truth_of(const Replayed& one) {
  if (!one.left_out.empty()) return kUnknown;
  if (one.truth.empty()) return kNone;
  for (const auto& h : one.said) {
    const auto ids = effects_in(h.id);
    if (ids.size() == one.truth.size() &&
        std::all_of(ids.begin(), ids.end(), [&](const std::string& id) { return one.truth.contains(id); }))
      return h.id;
  }
  std::string joined;
  for (const auto& [id, theta] : one.truth) joined += (joined.empty() ? "" : "+") + id;
  return joined;
}

double upper_limit(const Magnitude& magnitude, const Correction& correction) {
  return correction.widening_of_limits *
         std::max(std::fabs(magnitude.interval_90.first), std::fabs(magnitude.interval_90.second));
}

std::vector<Hypothesis> corrected(std::vector<Hypothesis> said, const Correction& correction) {
  std::vector<double> logs;
  for (const auto& h : said)
    logs.push_back(std::log(std::max(kNoProbability, h.probability)) +
                   h.log_evidence * (1.0 / correction.temperature - 1.0) +
                   (h.id == kUnknown ? correction.for_unknown : 0.0));
  const double total = log_sum(logs);
  for (std::size_t k = 0; k < said.size(); ++k) {
    said[k].probability = std::exp(logs[k] - total);
    const auto own = correction.widening.find(said[k].id);
    const double widening = own == correction.widening.end() ? correction.widening_of_others : own->second;
    for (auto& [mean, interval] : said[k].magnitudes)
      interval = {mean + widening * (interval.first - mean), mean + widening * (interval.second - mean)};
  }
  std::stable_sort(said.begin(), said.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return said;
}

AmbiguitySet set_of(const std::vector<Hypothesis>& said, const Correction& correction) {
  AmbiguitySet set;
  double known = 0.0;
  for (const auto& h : said)
    if (h.id != kUnknown) known += h.probability;
  const Hypothesis* unknown = said_of(said, kUnknown);
  const bool first = unknown && said.front().id == kUnknown;
  if (first) set.ids.push_back(kUnknown);
  if (!first || unknown->probability < kThresholds.unknown_alone) {
    double held = 0.0;
    for (const auto& h : said) {
      if (h.id == kUnknown) continue;
      const auto own = correction.levels.find(h.id);
      if (held <= (own == correction.levels.end() ? correction.level : own->second)) set.ids.push_back(h.id);
      held += h.probability / known;
    }
  }
  std::set<std::string> behind;
  for (const auto& h : said)
    if (stood_for(h, said, set, correction)) behind.insert(h.id);
  std::erase_if(set.ids, [&](const std::string& id) { return behind.contains(id); });
  if (unknown && !first && unknown->probability > correction.gate) set.ids.push_back(kUnknown);
  for (const auto& h : said)
    if (holds(set, h.id) || behind.contains(h.id)) set.probability += h.probability;
  return set;
}

Promise promise_of(const std::vector<Replayed>& replayed, double confidence) {
  Promise promise;
  promise.confidence = confidence;
  promise.correction.level = std::max(confidence, promise.correction.level);
  Learning all;
  std::set<int> members;
  for (const auto& one : replayed) {
    // A pair whose runs are all of one member is not known where that member is left out.
    if (one.truth.size() > 1 && !said_of(one.said, truth_of(one))) continue;
    (one.left_out.empty() ? all.known : all.outside).push_back(&one);
    members.insert(one.member);
  }
  if (all.known.size() < kThresholds.least_cases || members.size() < 3) return promise;
  promise.cases = all.known.size();
  promise.correction = learn(all, confidence);
  Bins bins;
  double magnitudes = 0.0;
  for (const int member : members) {
    const auto other = [&](const Replayed* one) { return one->member != member; };
    Learning others;
    std::copy_if(all.known.begin(), all.known.end(), std::back_inserter(others.known), other);
    std::copy_if(all.outside.begin(), all.outside.end(), std::back_inserter(others.outside), other);
    const Correction correction = learn(others, confidence);
    for (const auto* one : all.known)
      if (one->member == member) count(*one, correction, promise, bins, magnitudes);
    for (const auto* one : all.outside)
      if (one->member == member) count_outside(*one, correction, all.weight_outside(), promise, bins);
  }
  const double n = static_cast<double>(all.known.size());
  promise.in_set /= n, promise.set_size /= n, promise.false_alarms /= n;
  if (magnitudes > 0.0) promise.theta_held /= magnitudes, promise.limits_held /= magnitudes;
  promise.reliability = bins.reliability();
  return promise;
}

}  // namespace pendular::diagnosis
