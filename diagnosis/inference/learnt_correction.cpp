#include "diagnosis/inference/learnt_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "diagnosis/inference/log_sum.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kTemperatures[] = {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0};
constexpr double kRatios[] = {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0};  // of that of pairs
constexpr double kLeastProbability = 0.01;  // that a wrong answer is charged with: few runs are not to decide
constexpr double kHopeless = 60.0;          // evidence, as a logarithm, below the best one's
constexpr double kAsFar = 0.99;             // of a magnitude
constexpr int kLevelSteps = 5;              // in which a level is raised

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

/// A known explanation of a replayed run, for the search of temperatures.
struct Term {
  double prior, evidence, beyond_plainer;  ///< logarithms
};

struct Terms {
  std::vector<Term> all = {};
  std::optional<std::size_t> truth = {};
};

Terms terms_of(const Replayed& one) {
  Terms terms;
  const std::string truth = truth_of(one);
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& h : one.said) best = std::max(best, h.log_evidence);
  for (const auto& h : one.said) {
    if (h.id == kUnknown || (h.id != truth && h.log_evidence < best - kHopeless)) continue;
    if (h.id == truth) terms.truth = terms.all.size();
    terms.all.push_back({h.log_prior, h.log_evidence, names_two(h.id) ? beyond_plainer(h, one.said) : 0.0});
  }
  return terms;
}

/// Temperatures at which the known explanations' probabilities say most of what is true.
void learn_temperatures(const Cases& cases, Correction& found) {
  std::vector<Terms> runs;
  for (const auto* one : cases) runs.push_back(terms_of(*one));
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> logs;
  for (const double temperature : kTemperatures)
    for (const double ratio : kRatios) {
      const double of_pairs = 1.0 / (ratio * temperature) - 1.0 / temperature;
      double loss = 0.0;
      for (const auto& [all, truth] : runs) {
        logs.clear();
        for (const auto& term : all)
          logs.push_back(term.prior + term.evidence / temperature + of_pairs * term.beyond_plainer);
        const double of_truth = truth ? logs[*truth] - log_sum(logs) : std::log(kLeastProbability);
        loss -= std::max(std::log(kLeastProbability), of_truth);
      }
      if (loss < least)
        least = loss, found.temperature = temperature, found.temperature_of_pairs = ratio * temperature;
    }
}

bool holds_any(const AmbiguitySet& set, const std::vector<std::string>& ids) {
  return std::any_of(ids.begin(), ids.end(), [&](const std::string& id) { return holds(set, id); });
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
    for (const auto& id : not_told_from(truth, cases[k]->truth, found))
      level = std::min(level, before(said[k], id));
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

/// From where on effects are told from none, and the pairs that are told from none and their effects no more
/// often than slips explain.
void learn_what_is_told(const std::vector<std::vector<Hypothesis>>& said, const Cases& cases,
                        Correction& found) {
  std::map<std::string, std::pair<std::vector<ReplayedMagnitude>, std::vector<ReplayedMagnitude>>> effects;
  std::map<std::string, std::pair<int, int>> pairs;  // runs told apart, and all
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto& truth = cases[k]->truth;
    const AmbiguitySet set = set_of(said[k], found);
    if (truth.size() == 1) {
      const double theta = truth.begin()->second;
      auto& [negative, positive] = effects[truth.begin()->first];
      (theta < 0.0 ? negative : positive).push_back({theta, !holds(set, kNone), false});
    } else if (truth.size() == 2) {
      const std::string id = truth_of(*cases[k]);
      auto& [apart, all] = pairs[id];
      apart += !holds_any(set, plainer(id)), ++all;
    }
  }
  const auto from = [](const std::vector<ReplayedMagnitude>& runs) {
    return runs.empty() ? 0.0 : least_told(runs, kThresholds.told);  // of what was not run nothing is known
  };
  for (const auto& [id, runs] : effects) found.told_from[id] = {from(runs.first), from(runs.second)};
  for (const auto& [id, counts] : pairs)
    if (by_slips(counts.first, counts.second) > kThresholds.by_slip) found.untold_pairs.insert(id);
}

bool on_tables_of_beads(const std::string& id) {
  const auto& all = effects::all_effects();
  return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.id == id && one.beads; });
}

/// Widenings of intervals of θ that hold the magnitudes of some runs of single effects. Effects on tables of
/// beads have their own common one: that measured beads are only nearly found again
/// (kThresholds.error_of_beads) is not so of replayed ones, whose magnitudes come out too small by it.
Widening widening_of(const Cases& singles) {
  std::map<bool, std::vector<double>> alike;
  std::map<std::string, std::vector<double>> needed;
  for (const auto* one : singles) {
    const Hypothesis* truth = said_of(one->said, truth_of(*one));
    if (!truth) continue;
    const double factor = needed_widening(truth->magnitudes.front(), one->truth.begin()->second);
    alike[on_tables_of_beads(truth->id)].push_back(factor);
    needed[truth->id].push_back(factor);
  }
  std::map<bool, double> common;
  for (auto& [on_tables, values] : alike)
    common[on_tables] = std::max(1.0, conformal(std::move(values), kThresholds.of_theta));
  Widening found;
  if (common.contains(false)) found.others = common[false];
  for (auto& [id, values] : needed) {
    const double n = static_cast<double>(values.size()),
                 own = std::max(0.3, conformal(std::move(values), kThresholds.of_theta)),
                 log_common = std::log(common[on_tables_of_beads(id)]);
    found.own[id] = std::max(1.0, std::exp((n * std::log(own) + kThresholds.worth_of_all * log_common) /
                                           (n + kThresholds.worth_of_all)));
  }
  return found;
}

/// Widening of upper limits, which follow from intervals.
void learn_limits(const Cases& cases, Correction& found) {
  std::vector<double> limits;
  found.widening_of_limits = 1.0;
  for (const auto* one : cases) {
    if (one->truth.size() != 1) continue;
    const auto said = corrected(one->said, found);
    if (const Hypothesis* truth = said_of(said, truth_of(*one)))
      limits.push_back(std::fabs(one->truth.begin()->second) / std::max(1e-12, upper_limit(*truth, found)));
  }
  found.widening_of_limits = limits.empty()
                                 ? Correction{}.widening_of_limits
                                 : std::max(1.0, conformal(std::move(limits), kThresholds.of_limits));
}

/// Levels at which replayed sets are right as often as asked for. Where something stands for the truth that
/// is told apart all the same, no level helps: more of the others are asked for, half of what is left at
/// most.
void learn_levels_of_right_sets(const std::vector<std::vector<Hypothesis>>& said, const Cases& cases,
                                double confidence, Correction& found) {
  for (int step = 0; step < kLevelSteps; ++step) {
    learn_levels(said, cases, confidence + 0.5 * (1.0 - confidence) * step / kLevelSteps, found);
    double held = 0.0;
    for (std::size_t k = 0; k < cases.size(); ++k) held += right(set_of(said[k], found), *cases[k], found);
    if (held >= confidence * static_cast<double>(cases.size())) return;
  }
}

}  // namespace

Cases singles_of(const Cases& cases) {
  Cases singles;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(singles),
               [](const Replayed* one) { return one->truth.size() == 1; });
  return singles;
}

Cases spanned(const Cases& singles) {
  const auto farther = [](const Replayed& one, const Replayed& other) {
    const auto& [id, theta] = *one.truth.begin();
    const auto& [other_id, beyond] = *other.truth.begin();
    return other.member != one.member && other_id == id && (theta < 0.0) == (beyond < 0.0) &&
           std::fabs(beyond) >= kAsFar * std::fabs(theta);
  };
  Cases found;
  std::copy_if(singles.begin(), singles.end(), std::back_inserter(found), [&](const Replayed* one) {
    return std::any_of(singles.begin(), singles.end(),
                       [&](const Replayed* other) { return farther(*one, *other); });
  });
  return found;
}

bool right(const AmbiguitySet& set, const Replayed& one, const Correction& correction) {
  const std::string truth = truth_of(one);
  return holds(set, truth) || holds_any(set, not_told_from(truth, one.truth, correction));
}

double least_told(std::vector<ReplayedMagnitude> runs, double share) {
  std::stable_sort(runs.begin(), runs.end(),
                   [](const auto& a, const auto& b) { return std::fabs(a.theta) > std::fabs(b.theta); });
  double beyond = 0.0, most = 0.0, from = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    beyond += (runs[k].told_from_none ? 1.0 : 0.0) - share;
    const bool last_of_level =
        k + 1 == runs.size() || std::fabs(runs[k + 1].theta) < std::fabs(runs[k].theta);
    if (last_of_level && beyond >= most) most = beyond, from = std::fabs(runs[k].theta);
  }
  return from;
}

Correction learn(const Cases& cases, double confidence, const Misfit& misfit) {
  Correction found;
  found.misfit = {misfit.odds, misfit.power_of_replayed, misfit.power_of_replayed};
  found.gate = kThresholds.lets_unknown_in;
  learn_temperatures(cases, found);
  for (const auto* one : cases)
    if (one->truth.size() < 2) found.misfits.push_back(left_by_plain(one->said));
  std::sort(found.misfits.begin(), found.misfits.end());
  std::vector<std::vector<Hypothesis>> said;
  for (const auto* one : cases) said.push_back(corrected(one->said, found));
  learn_levels(said, cases, confidence, found);
  learn_what_is_told(said, cases, found);
  learn_levels_of_right_sets(said, cases, confidence, found);
  const Cases singles = singles_of(cases);
  found.widening = widening_of(spanned(singles)), found.of_all = widening_of(singles);
  learn_limits(cases, found);
  return found;
}

}  // namespace pendular::diagnosis
