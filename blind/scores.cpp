#include "blind/scores.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "diagnosis/inference/evidence.h"
#include "effects/list.h"

namespace pendular::blind {
namespace {

constexpr double kConfident = 0.9;
constexpr double kReached = 0.7;  // of what the true effects close

template <typename Wanted>
std::vector<Verdict> those(const std::vector<Verdict>& verdicts, const Wanted& wanted) {
  std::vector<Verdict> found;
  std::copy_if(verdicts.begin(), verdicts.end(), std::back_inserter(found), wanted);
  return found;
}

/// Probability of all right answers.
double right_probability(const Verdict& verdict, Counting counting) {
  double sum = 0.0;
  if (verdict.said)
    for (const auto& [id, claim] : verdict.said->claims)
      if (is_right(verdict, id, counting)) sum += claim.probability;
  return sum;
}

Naming naming(const std::vector<Verdict>& verdicts, Counting counting = Counting::by_name) {
  Naming naming;
  std::vector<double> sizes, logs, briers;
  for (const auto& verdict : verdicts) {
    const auto right = [&](const std::string& id) { return is_right(verdict, id, counting); };
    const std::vector<std::string> set = verdict.said ? verdict.said->set : std::vector<std::string>{};
    const auto rights = std::count_if(set.begin(), set.end(), right);
    const bool exact = verdict.said && right(verdict.top());
    naming.in_set.count(rights > 0);
    naming.exact.count(exact);
    naming.confidently_wrong.count(verdict.said && !exact && verdict.probability(verdict.top()) > kConfident);
    logs.push_back(log_score(verdict, counting));
    briers.push_back(brier_score(verdict, counting));
    if (!verdict.said) continue;
    const auto size = static_cast<std::ptrdiff_t>(set.size()) - std::max<std::ptrdiff_t>(0, rights - 1);
    sizes.push_back(static_cast<double>(size));
    if (size == 1) naming.exact_separable.count(exact);
  }
  naming.set_size = mean(sizes), naming.log_score = mean(logs), naming.brier = mean(briers);
  return naming;
}

/// Probabilities before any data: a case for which nothing but the priors was said.
Verdict by_priors(const Verdict& verdict) {
  const diagnosis::Priors priors;
  std::vector<std::string> ids;
  for (const auto& effect : effects::all_effects()) ids.push_back(effect.id);
  const double effects = static_cast<double>(ids.size());
  Diagnosed said;
  said.claims["none"].probability = priors.none;
  said.claims["unknown"].probability = priors.unknown;
  for (std::size_t a = 0; a < ids.size(); ++a) {
    said.claims[ids[a]].probability = (1.0 - priors.none - priors.unknown - priors.pairs) / effects;
    for (std::size_t b = a + 1; b < ids.size(); ++b)
      said.claims[in_order(ids[a] + "+" + ids[b])].probability =
          priors.pairs / (0.5 * effects * (effects - 1.0));
  }
  return {verdict.truth, verdict.answer, said, ""};
}

std::vector<ReliabilityBin> reliability(const std::vector<Verdict>& verdicts) {
  std::vector<ReliabilityBin> bins;
  double from = 0.0;
  for (const double to : {0.4, 0.6, 0.8, 0.9, 1.0}) {  // those of a report
    ReliabilityBin bin{from, to, 0.0, {}, {}};
    std::vector<double> said;
    for (const auto& verdict : verdicts) {
      const double p = verdict.probability(verdict.top());
      if (!verdict.said || p < from || (p >= to && to < 1.0)) continue;
      said.push_back(p);
      bin.right.count(verdict.exact());
      bin.right_by_class.count(is_right(verdict, verdict.top(), Counting::by_class));
    }
    bin.mean_probability = mean(said);
    bins.push_back(bin);
    from = to;
  }
  return bins;
}

MagnitudeScore magnitudes(const std::vector<Verdict>& verdicts) {
  MagnitudeScore found;
  std::vector<double> errors;
  for (const auto& verdict : verdicts) {
    if (!verdict.said || verdict.truth.effects.size() != 1) continue;
    const auto& [id, theta] = verdict.truth.effects.front();
    const auto claim = verdict.said->claims.find(id);
    if (claim == verdict.said->claims.end()) continue;
    if (claim->second.magnitude)
      errors.push_back(std::fabs(*claim->second.magnitude - theta) / std::fabs(theta));
    if (const auto& interval = claim->second.interval_90)
      found.covered.count(interval->first <= theta && theta <= interval->second);
  }
  found.median_relative_error = quantile(errors, 0.5);
  return found;
}

ShrinkageScore shrinkage(const std::vector<Verdict>& verdicts) {
  ShrinkageScore found;
  std::vector<double> withheld, retuned, wrong, above, closable, closed;
  for (const auto& verdict : verdicts) {
    if (!verdict.said || verdict.truth.effects.empty() || !verdict.said->withheld) continue;
    withheld.push_back(*verdict.said->withheld);
    if (verdict.said->wrong_effect) wrong.push_back(*verdict.said->wrong_effect);
    if (verdict.said->closable) {
      closable.push_back(*verdict.said->closable), closed.push_back(withheld.back());
      found.reached.count(closed.back() >= kReached * closable.back());
    }
    if (!verdict.said->retuned) continue;
    retuned.push_back(*verdict.said->retuned);
    above.push_back(withheld.back() - retuned.back());
  }
  found.cases = withheld.size(), found.oracles = closable.size();
  found.withheld = quantile(withheld, 0.5), found.retuned = quantile(retuned, 0.5),
  found.wrong_effect = quantile(wrong, 0.5);
  found.above_retuned = quantile(above, 0.5), found.closable = quantile(closable, 0.5),
  found.closed = quantile(closed, 0.5);
  return found;
}

/// Whether the replay of a diagnosis has cases like this one.
bool is_replayed(const Verdict& verdict) {
  return verdict.truth.mechanism.empty() && verdict.truth.effects.size() < 2 && verdict.answer != "unknown";
}

/// Upper limits of effects that are there and that reports call hardly shown.
Proportion limits_held(const std::vector<Verdict>& verdicts) {
  Proportion held;
  for (const auto& verdict : verdicts) {
    if (!verdict.said) continue;
    for (const auto& [id, theta] : verdict.truth.effects)
      if (const auto limit = verdict.said->limits.find(id); limit != verdict.said->limits.end())
        held.count(std::fabs(theta) <= limit->second);
  }
  return held;
}

bool in_its_set(const Verdict& verdict) {
  return verdict.in_set(verdict.answer);
}
bool is_flagged(const Verdict& verdict) {
  return verdict.in_set("unknown") || verdict.exact();
}

/// Of the verdicts whose replay says so.
template <typename Came>
Expectation expectation(const std::vector<Verdict>& verdicts,
                        std::optional<double> (Verdict::*expected)() const, const Came& came) {
  Expectation found;
  std::vector<double> shares;
  for (const auto& verdict : verdicts)
    if (const auto share = (verdict.*expected)()) {
      shares.push_back(*share);
      found.came.count(came(verdict));
    }
  found.expected = mean(shares);
  return found;
}

Kept kept(const std::vector<Verdict>& verdicts) {
  Kept kept;
  std::vector<double> in_set, size, theta, alarms, sizes;
  std::vector<Verdict> promising;
  for (const auto& verdict : verdicts) {
    kept.confidently_wrong.count(verdict.confidently_wrong());
    if (!verdict.said) continue;
    if (verdict.answer != "unknown") kept.unknown_alarms.count(verdict.in_set("unknown"));
    const auto& promised = verdict.said->promised;
    if (!promised || !is_replayed(verdict)) continue;
    in_set.push_back(promised->in_set), size.push_back(promised->set_size);
    theta.push_back(promised->theta_held), alarms.push_back(promised->false_alarms);
    kept.in_set.count(verdict.set_is_right());
    promising.push_back(verdict);
    sizes.push_back(static_cast<double>(verdict.said->set.size()));
  }
  kept.promises = in_set.size(), kept.set_size = mean(sizes);
  kept.promised_in_set = mean(in_set), kept.promised_size = mean(size);
  kept.there = expectation(promising, &Verdict::promised_in_set, in_its_set);
  kept.promised_theta = mean(theta), kept.promised_alarms = mean(alarms);
  kept.magnitude = magnitudes(verdicts);
  kept.reliability = reliability(verdicts);
  return kept;
}

Bars bars(const std::vector<Verdict>& verdicts) {
  Bars bars;
  bars.naming = naming(verdicts);
  for (const auto& verdict : verdicts) {
    bars.set_is_right.count(verdict.set_is_right());
    if (verdict.truth.effects.size() == 1) bars.single_first.count(verdict.exact());
    if (verdict.truth.effects.size() == 2) bars.pairs_in_set.count(verdict.in_set(verdict.answer));
    if (verdict.truth.mechanism.empty()) continue;
    bars.flagged.count(is_flagged(verdict));
    bars.misnamed.count(verdict.confidently_wrong());
  }
  bars.magnitude = magnitudes(verdicts);
  bars.in_set_there = expectation(those(verdicts, is_replayed), &Verdict::promised_in_set, in_its_set);
  bars.first_there = expectation(verdicts, &Verdict::promised_first, [](const auto& v) { return v.exact(); });
  bars.pairs_there = expectation(verdicts, &Verdict::promised_pairs, in_its_set);
  bars.flagged_there = expectation(verdicts, &Verdict::promised_flagged, is_flagged);
  return bars;
}

HiddenScore hidden_score(const std::vector<Verdict>& verdicts) {
  HiddenScore found;
  for (const auto& verdict : verdicts) {
    found.allowed.count(verdict.in_set("none") || verdict.in_set(verdict.answer));
    found.misnamed.count(verdict.confidently_wrong() && verdict.top() != "none");
  }
  return found;
}

void score_unknown(Scores& scores, const std::vector<Verdict>& verdicts) {
  std::vector<double> outside, inside;
  for (const auto& verdict : verdicts) {
    const bool right = verdict.answer == "unknown";
    (right ? outside : inside).push_back(verdict.probability("unknown"));
    if (!right) continue;
    scores.flagged.count(is_flagged(verdict));
    scores.misnamed.count(verdict.confidently_wrong());
  }
  scores.auroc_unknown = area_under_curve(outside, inside);
}

}  // namespace

double log_score(const Verdict& verdict, Counting counting) {
  return -std::log(std::max(kLeastProbability, right_probability(verdict, counting)));
}

double brier_score(const Verdict& verdict, Counting counting) {
  if (!verdict.said) return 2.0;
  double sum = std::pow(1.0 - right_probability(verdict, counting), 2);
  for (const auto& [id, claim] : verdict.said->claims)
    if (!is_right(verdict, id, counting)) sum += claim.probability * claim.probability;
  return sum;
}

Scores score(const std::vector<Verdict>& all, bool without_truth) {
  Scores scores;
  scores.without_truth = without_truth;
  scores.cases = all.size();
  const auto verdicts = those(all, [](const Verdict& v) { return !v.truth.hidden; });
  scores.hidden = hidden_score(those(all, [](const Verdict& v) { return v.truth.hidden; }));
  for (std::size_t k = 0; k < kObserved; ++k)
    scores.by_observed[k] =
        bars(those(verdicts, [&](const Verdict& v) { return v.truth.observed == static_cast<Observed>(k); }));
  for (const bool scanned : {false, true})
    (scanned ? scores.other_engine_with_scan : scores.other_engine_without_scan) =
        bars(those(verdicts, [&](const Verdict& v) {
          return (v.truth.observed == Observed::scan) == scanned && v.truth.stratum == Stratum::other_engine;
        }));
  scores.all = naming(verdicts), scores.all_by_class = naming(verdicts, Counting::by_class);
  scores.kept = kept(verdicts), scores.kept.limits = limits_held(all);
  std::vector<Verdict> priors;
  for (const auto& verdict : verdicts) {
    scores.failed += !verdict.said;
    scores.with_distances += verdict.said && !verdict.said->squared_distance.empty();
    priors.push_back(by_priors(verdict));
    if (verdict.said && verdict.said->nearest_signature)
      scores.nearest_signature.count(*verdict.said->nearest_signature == verdict.answer);
    if (verdict.truth.stratum != Stratum::none) continue;
    scores.false_alarms.count(!verdict.in_set("none"));
    scores.none_not_first.count(!verdict.exact());
  }
  for (const auto& verdict : verdicts) {
    const auto like = [&](const Verdict& other) { return other.truth.stratum == verdict.truth.stratum; };
    const Stratum stratum = verdict.truth.stratum;
    if (!scores.by_stratum.contains(stratum)) {
      const auto cases = those(verdicts, like);
      scores.by_stratum[stratum] = naming(cases), scores.kept_by_stratum[stratum] = kept(cases);
      scores.kept_by_stratum[stratum].limits = limits_held(those(all, like));
      scores.by_stratum_and_class[stratum] = naming(cases, Counting::by_class);
    }
    const auto same = [&](const Verdict& other) { return other.answer == verdict.answer; };
    scores.by_answer[verdict.answer] = naming(those(verdicts, same));
  }
  const Naming prior = naming(priors);
  scores.prior_log_score = prior.log_score, scores.prior_brier = prior.brier;
  score_unknown(scores, verdicts);
  scores.magnitude = magnitudes(verdicts);
  scores.magnitude_where_named = magnitudes(those(verdicts, [](const Verdict& v) { return v.exact(); }));
  scores.shrinkage = shrinkage(verdicts);
  return scores;
}

}  // namespace pendular::blind
