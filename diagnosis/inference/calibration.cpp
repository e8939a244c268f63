#include "diagnosis/inference/calibration.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/inference/learnt_correction.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr double kConfident = 0.9;  // probability of what is said without doubt
constexpr double kBins[] = {0.0, 0.4, 0.6, 0.8, 0.9, 1.0};

/// How often replayed sets are to be right, for measured ones to be so with this confidence.
double of_replayed(double confidence) {
  return 1.0 - kThresholds.missed_by_replay * (1.0 - confidence);
}

/// Adds what a run whose effect was left out shows of corrections that did not see its member.
void count_outside(const Replayed& one, const Correction& correction, OutsideReplay& outside) {
  const auto said = corrected(one.said, correction);
  ++outside.cases;
  outside.flagged += holds(set_of(said, correction), kUnknown);
  outside.misnamed += said.front().id != kUnknown && said.front().probability > kConfident;
}

/// Adds what a pair shows of them, where each of its effects would be told by itself.
void count_pair(const Replayed& one, const Correction& correction, PairReplay& pairs) {
  for (const auto& [id, theta] : one.truth)
    if (!correction.tells(id, theta)) return;
  const auto said = corrected(one.said, correction);
  const std::string truth = truth_of(one);
  ++pairs.cases;
  pairs.in_set += holds(set_of(said, correction), truth);
  pairs.first += said.front().id == truth;
}

/// Replayed runs of which each share of a promise is one.
struct Counted {
  double plain = 0.0, limits = 0.0, intervals = 0.0;
};

/// Adds what one replayed run shows of corrections that did not see its member.
void count(const Replayed& one, bool within_span, const Correction& correction, Promise& promise,
           std::vector<Reliability>& bins, Counted& counted) {
  const auto said = corrected(one.said, correction);
  const AmbiguitySet set = set_of(said, correction);
  const std::string truth = truth_of(one);
  promise.in_set += right(set, one, correction);
  promise.set_size += static_cast<double>(set.ids.size());
  if (one.truth.size() < 2) promise.false_alarms += holds(set, kUnknown), counted.plain += 1.0;
  const double top = said.front().probability;
  const auto bin =
      static_cast<std::size_t>(std::upper_bound(kBins + 1, std::end(kBins) - 1, top) - kBins - 1);
  bins[bin].said += top, bins[bin].came_true += said.front().id == truth, ++bins[bin].cases;
  EffectReplay& effect = one.truth.empty() ? promise.none : promise.effects[truth];
  ++effect.cases;
  effect.told_from_none += !holds(set, kNone);
  effect.first += said.front().id == truth;
  effect.in_set += right(set, one, correction);
  if (one.truth.size() == 1)
    effect.runs.push_back(
        {one.truth.begin()->second, !holds(set, kNone), holds(set, truth), said.front().id == truth});
  if (one.truth.empty()) return;
  const Hypothesis* named = said_of(said, truth);
  if (!named || one.truth.size() > 1) return;
  const auto& [low, high] = named->magnitudes.front().interval_90;
  const double theta = one.truth.begin()->second;
  if (within_span) promise.theta_held += low <= theta && theta <= high, counted.intervals += 1.0;
  promise.limits_held += std::fabs(theta) <= upper_limit(*named, correction);
  counted.limits += 1.0;
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

double EffectReplay::seen_from() const {
  return least_told(runs, kThresholds.seen);
}

Promise promise_of(const std::vector<Replayed>& replayed, double confidence, const Misfit& misfit) {
  Promise promise;
  promise.confidence = confidence;
  promise.correction.level = std::max(confidence, promise.correction.level);
  Cases cases, outside, pairs;
  std::set<int> members;
  for (const auto& one : replayed) {
    (one.put_together ? pairs : one.left_out.empty() ? cases : outside).push_back(&one);
    members.insert(one.member);
  }
  if (cases.size() < kThresholds.least_cases || members.size() < 3) return promise;
  promise.cases = cases.size();
  promise.of_replayed = learn(cases, of_replayed(confidence), misfit);
  promise.correction = promise.of_replayed;
  promise.correction.misfit = misfit;
  std::vector<Reliability> bins(std::size(kBins) - 1);
  const Cases within = spanned(singles_of(cases));
  const std::set<const Replayed*> of_spanned(within.begin(), within.end());
  Counted counted;
  for (const int member : members) {
    Cases others;
    std::copy_if(cases.begin(), cases.end(), std::back_inserter(others),
                 [&](const Replayed* one) { return one->member != member; });
    const Correction without = learn(others, of_replayed(confidence), misfit);
    for (const auto* one : cases)
      if (one->member == member) count(*one, of_spanned.contains(one), without, promise, bins, counted);
    for (const auto* one : outside)
      if (one->member == member) count_outside(*one, without, promise.outside);
    for (const auto* one : pairs)
      if (one->member == member) count_pair(*one, without, promise.pairs);
  }
  const double n = static_cast<double>(cases.size());
  promise.in_set /= n, promise.set_size /= n;
  if (counted.plain > 0.0) promise.false_alarms /= counted.plain;
  if (counted.limits > 0.0) promise.limits_held /= counted.limits;
  if (counted.intervals > 0.0) promise.theta_held /= counted.intervals;
  for (auto& bin : bins) {
    if (bin.cases == 0) continue;
    bin.said /= static_cast<double>(bin.cases), bin.came_true /= static_cast<double>(bin.cases);
    promise.reliability.push_back(bin);
  }
  return promise;
}

}  // namespace pendular::diagnosis
