#include "diagnosis/inference/judgement.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/distributions.h"
#include "base/quantity.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/inference/correction.h"
#include "diagnosis/inference/reduced_space.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/thresholds.h"
#include "diagnosis/words.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

const Signature* signature_of(const Comparison& comparison, const std::string& id) {
  for (const auto& signature : comparison.signatures)
    if (signature.id == id) return &signature;
  return nullptr;
}

/// The feature that a residual leaves farthest off, in words.
std::string worst_of(const Comparison& landmarks, const Eigen::VectorXd& left) {
  const Eigen::MatrixXd covariance = whole_covariance(landmarks.gap);
  const Eigen::VectorXd z = left.cwiseQuotient(covariance.diagonal().cwiseSqrt());
  Eigen::Index at = 0;
  const double most = z.cwiseAbs().maxCoeff(&at);
  const Feature& feature = landmarks.observed.features[static_cast<std::size_t>(at)];
  return fmt::format("{} is {:.1f} sigma off", in_words(feature), most);
}

/// p-value of a χ² under noise alone, whose covariance is known with `dof` degrees of freedom (0: exactly):
/// the residual is multivariate t, its square over the number of features Fisher's F.
double p_value_of(double chi_squared, Eigen::Index features, double dof) {
  const auto p = static_cast<double>(features);
  if (features == 0) return 1.0;
  return dof > 0.0 ? f_tail(chi_squared / p, p, dof) : chi_squared_tail(chi_squared, p);
}

/// The single effect of least χ²: none where the gap is within the noise.
std::string nearest_signature(const std::vector<Hypothesis>& hypotheses, Eigen::Index features) {
  const Hypothesis* nearest = nullptr;
  for (const auto& h : hypotheses) {
    if (h.id == "none" && h.chi_squared <= static_cast<double>(features)) return h.id;
    if (h.magnitudes.size() == 1 && (!nearest || h.chi_squared < nearest->chi_squared)) nearest = &h;
  }
  return nearest ? nearest->id : "none";
}

/// Probability of everything that holds an effect.
double marginal(const std::vector<Hypothesis>& hypotheses, const std::string& effect) {
  double sum = 0.0;
  for (const auto& h : hypotheses) {
    const auto ids = effects_in(h.id);
    if (std::find(ids.begin(), ids.end(), effect) != ids.end()) sum += h.probability;
  }
  return sum;
}

/// Intervals that a correction has widened do not go beyond what effects can be.
std::vector<Hypothesis> within_range(std::vector<Hypothesis> hypotheses) {
  for (auto& h : hypotheses) {
    const auto ids = effects_in(h.id);
    for (std::size_t k = 0; k < h.magnitudes.size(); ++k) {
      const effects::Effect& effect = effects::find_effect(ids[k], "diagnosis");
      auto& [low, high] = h.magnitudes[k].interval_90;
      low = std::clamp(low, effect.lowest, effect.highest);
      high = std::clamp(high, effect.lowest, effect.highest);
    }
  }
  return hypotheses;
}

/// Why a single effect is out of the question.
std::string why_excluded(const Problem& problem, const Hypothesis& h, double chi_squared_of_none,
                         double visible, const Rules& rules) {
  const Signature& signature = *signature_of(problem.readings, h.id);
  if (visible < rules.separable) return "these observations would hardly show it at any usual magnitude";
  if (chi_squared_of_none - h.chi_squared < 1.0) {
    const std::string both = signature.lowest < 0.0 ? "at either sign it" : "it";
    return fmt::format("{} moves the features away from what was observed, or not at all; {}", both,
                       worst_of(problem.landmarks, problem.landmarks.gap.values));
  }
  const double theta = h.magnitudes.front().mean;
  const std::string unit = effects::find_effect(h.id, "diagnosis").unit;
  return fmt::format("at its best magnitude, {}, {}", quantity(theta, h.magnitudes.front().interval_90, unit),
                     worst_of(problem.landmarks, left_by(problem.landmarks, {{h.id, h.magnitudes.front()}})));
}

/// What is unknown may do to a curve what a known effect does, but hardly to thousands of displacements.
Priors priors_of(const Comparison& readings, const Rules& rules) {
  Priors priors = rules.priors;
  if (std::find(readings.inputs.begin(), readings.inputs.end(), kFieldError) != readings.inputs.end())
    priors.like_known = rules.like_known_in_fields, priors.misfit = rules.misfit_in_fields;
  return priors;
}

/// Of all observations the least probable by chance, as the least of so many.
Unlike unlike_of(const Experiment& experiment) {
  Unlike least;
  double looked_at = 0.0;
  for (const auto& observation : experiment.observations) {
    if (!observation.kind->unlike) continue;
    looked_at += 1.0;
    if (Unlike one = observation.kind->unlike(observation); one.by_chance < least.by_chance)
      least = std::move(one);
  }
  least.by_chance = std::min(1.0, std::max(1.0, looked_at) * least.by_chance);
  return least;
}

/// The most that odds can rise by something of this probability by chance (Sellke, Bayarri & Berger 2001, Am.
/// Stat. 55, 62), less that of nothing.
double odds_by_itself(double by_chance) {
  const double p = std::max(by_chance, kThresholds.least_by_chance);
  return p < std::exp(-1.0) ? kThresholds.unlike_all * (-1.0 / (M_E * p * std::log(p)) - 1.0) : 0.0;
}

void set_unlike(const Experiment& experiment, Diagnosis& diagnosis) {
  const auto& [by_chance, what] = unlike_of(experiment);
  double& odds = diagnosis.promise.correction.odds_by_itself;
  odds = odds_by_itself(by_chance);
  if (odds / (1.0 + odds) > kThresholds.lets_unknown_in) diagnosis.unlike = what;
}

bool told_at_no_magnitude(const effects::Effect& effect, const Correction& correction) {
  return !(effect.lowest < 0.0 && correction.tells(effect.id, effect.lowest)) &&
         !(effect.highest > 0.0 && correction.tells(effect.id, effect.highest));
}

/// After the set. Effects outside it that none stands for there, or that are told at no magnitude, and how
/// large they may be.
void set_unseen(const AmbiguitySet& set, const std::vector<Hypothesis>& hypotheses, Diagnosis& diagnosis) {
  const Correction& correction = diagnosis.promise.correction;
  for (const auto& h : hypotheses) {
    if (h.magnitudes.size() != 1 || holds(set, h.id)) continue;
    const effects::Effect& effect = effects::find_effect(h.id, "diagnosis");
    if (!stands_for(h, set, hypotheses, correction) && !told_at_no_magnitude(effect, correction)) continue;
    const double largest = std::max(std::fabs(effect.lowest), std::fabs(effect.highest));
    diagnosis.unseen.push_back({h.id, effect.unit, std::min(largest, upper_limit(h, correction))});
  }
}

bool is_unseen(const Diagnosis& diagnosis, const std::string& id) {
  return std::any_of(diagnosis.unseen.begin(), diagnosis.unseen.end(),
                     [&](const Unseen& one) { return one.effect == id; });
}

/// After the set and the unseen, which are not excluded. `directions`: of the reduced space in which χ² is.
void set_explanations(const Problem& problem, const AmbiguitySet& set,
                      const std::vector<Hypothesis>& hypotheses, Eigen::Index directions, const Rules& rules,
                      const BankPlan& plan, Diagnosis& diagnosis) {
  double chi_squared_of_none = 0.0;
  for (const auto& h : hypotheses)
    if (h.id == "none") chi_squared_of_none = h.chi_squared;
  for (const auto& h : hypotheses) {
    Explanation e{h.id, h.probability, h.magnitudes, {}, h.chi_squared / static_cast<double>(directions)};
    const auto ids = effects_in(h.id);
    for (const auto& id : ids) e.units.push_back(effects::find_effect(id, "diagnosis").unit);
    if (ids.size() == 1 && !holds(set, h.id) && !is_unseen(diagnosis, h.id) &&
        h.probability < rules.excluded &&
        marginal(hypotheses, h.id) < kThresholds.with_pairs * rules.excluded) {
      const auto row =
          std::find(diagnosis.effects.begin(), diagnosis.effects.end(), h.id) - diagnosis.effects.begin();
      const double visible = diagnosis.separation(row, diagnosis.separation.cols() - 1);
      e.reason = why_excluded(problem, h, chi_squared_of_none, visible, rules);
      e.excluded = visible >= rules.separable;
    }
    if (const Hypothesis* member = stands_for(h, set, hypotheses, diagnosis.promise.correction);
        member && !e.excluded)
      e.reason = "not told from " + plain_name(member->id);
    if (h.id == "unknown")
      if (const char* why = why_unknown(hypotheses, diagnosis.promise.correction))
        e.reason = diagnosis.unlike.empty() ? why : diagnosis.unlike;
    diagnosis.explanations.push_back(std::move(e));
  }
  for (const auto& [id, why] : plan.absent) {
    Explanation e{id, 0.0, {Magnitude{}}, {effects::find_effect(id, "diagnosis").unit}, 0.0, true, why};
    diagnosis.explanations.push_back(std::move(e));
  }
}

void set_groups(const Problem& problem, const Experiment& experiment, Diagnosis& diagnosis) {
  std::vector<std::string> singles;
  for (const auto& id : diagnosis.ambiguity_set)
    for (const auto& effect : effects_in(id))
      if (std::find(singles.begin(), singles.end(), effect) == singles.end()) singles.push_back(effect);
  for (const auto& effect : singles)
    for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
      const auto features = features_from(problem.readings, {index});
      if (features.empty()) continue;
      const Signature signature = part_of({*signature_of(problem.readings, effect)}, features).front();
      const auto found = weigh(part_of(problem.readings.gap, features), {signature});
      for (const auto& h : found)
        if (h.id == effect)
          diagnosis.groups.push_back({effect, experiment.observations[index].name, h.magnitudes.front()});
    }
}

/// Posterior of the believed inputs once the best explanation is taken off the gap.
void set_pulls(const Comparison& readings, const Magnitudes& best, const Experiment& experiment,
               Diagnosis& diagnosis) {
  const Gap& gap = readings.gap;
  const Eigen::MatrixXd covariance = whole_covariance(gap);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd pull = pulls_of(gap, left_by(readings, best));
  const Eigen::MatrixXd known = gap.believed.transpose() * factor.solve(gap.believed);
  const Eigen::VectorXd noise = gap.covariance.diagonal().cwiseSqrt();
  const auto sds = floating_inputs(experiment);
  for (std::size_t c = 0; c < readings.inputs.size(); ++c) {
    if (readings.inputs[c].ends_with(kCurvature)) continue;
    const auto at = static_cast<Eigen::Index>(c);
    const auto stated = sds.find(readings.inputs[c]);
    Pull one{readings.inputs[c], stated == sds.end() ? 0.0 : stated->second, pull[at],
             std::sqrt(std::max(0.0, 1.0 - known(at, at)))};
    one.impact =
        gap.believed.col(at).cwiseQuotient(noise).norm() / std::sqrt(static_cast<double>(noise.size()));
    diagnosis.pulls.push_back(one);
  }
}

/// Readings of the law that pulls show. Where no explanation has a name they take up what they can of it.
void set_law(const Experiment& experiment, const BankPlan& plan, Diagnosis& diagnosis) {
  const std::string& best = diagnosis.explanations.front().id;
  if (best == kUnknown || best == kOtherPairs) return;
  for (const auto& reading : law_readings())
    for (const auto& pull : diagnosis.pulls) {
      const double known_to = share_of_law(plan, reading), share = known_to * pull.pull;
      if (pull.key == reading.name && share > kThresholds.least_followed &&
          share < kThresholds.most_followed && pull.pull > kThresholds.followed_by * pull.spread)
        diagnosis.law.push_back({other_setting(reading, experiment.sample), share, known_to * pull.spread});
    }
}

void set_signatures(const Problem& problem, Diagnosis& diagnosis) {
  const Comparison& landmarks = problem.landmarks;
  const Eigen::VectorXd noise = whole_covariance(landmarks.gap).diagonal().cwiseSqrt();
  diagnosis.signatures =
      Eigen::MatrixXd(static_cast<Eigen::Index>(landmarks.signatures.size()), noise.size());
  for (std::size_t e = 0; e < landmarks.signatures.size(); ++e) {
    const Signature& signature = landmarks.signatures[e];
    diagnosis.effects.push_back(signature.id);
    diagnosis.signatures.row(static_cast<Eigen::Index>(e)) =
        signature.at(signature.scale).cwiseQuotient(noise).transpose();
  }
  diagnosis.separation = isolability(problem.readings.gap, problem.readings.signatures);
}

}  // namespace

Magnitudes fitted_magnitudes(const Problem& problem, const std::vector<std::string>& ids,
                             const std::vector<std::size_t>& observations) {
  const auto features = features_from(problem.readings, observations);
  std::vector<Signature> signatures;
  for (const auto& id : ids) signatures.push_back(*signature_of(problem.readings, id));
  if (signatures.empty() || features.empty()) return {};
  std::string name = ids.front();
  for (std::size_t k = 1; k < ids.size(); ++k) name += "+" + ids[k];
  Magnitudes found;
  for (const auto& h : weigh(part_of(problem.readings.gap, features), part_of(signatures, features),
                             part_of(problem.readings.together, features))) {
    if (h.id != name) continue;
    for (std::size_t k = 0; k < ids.size(); ++k) found[ids[k]] = h.magnitudes[k];
  }
  return found;
}

std::set<std::size_t> truly_strained(const Comparison& comparison, const Magnitudes& magnitudes) {
  std::set<std::size_t> found;
  for (const auto& [id, m] : magnitudes) {
    const Signature* signature = signature_of(comparison, id);
    if (!signature || m.reading == 0) continue;
    const Eigen::VectorXd by_machine = signature->at(m.mean),
                          read = signature->response(m.mean, m.reading).at(m.mean);
    for (std::size_t f = 0; f < comparison.observed.features.size(); ++f) {
      const auto at = static_cast<Eigen::Index>(f);
      if (by_machine[at] != 0.0 && read[at] == 0.0) found.insert(comparison.observed.observation[f]);
    }
  }
  return found;
}

Changes changes_of(const Magnitudes& magnitudes) {
  Changes changes;
  for (const auto& [id, m] : magnitudes) changes[id] = m.mean;
  return changes;
}

void judge(const Problem& problem, const Rules& rules, const BankPlan& plan, const Experiment& experiment,
           Diagnosis& diagnosis) {
  const Comparison &landmarks = problem.landmarks, &readings = problem.readings;
  std::vector<double> simulated;
  for (std::size_t f = 0; f < landmarks.observed.features.size(); ++f) {
    const double value = landmarks.simulated[static_cast<Eigen::Index>(f)];
    simulated.push_back(landmarks.observed.features[f].logarithm ? std::exp(value) : value);
  }
  diagnosis.gap = gap_table(landmarks.observed.features, simulated, landmarks.gap);
  diagnosis.noise = landmarks.noise;
  set_signatures(problem, diagnosis);
  const Priors priors = priors_of(readings, rules);
  diagnosis.promise = promise_of(
      problem.features ? replay(experiment, plan, *problem.features, priors, rules.draws, Replays::all)
                       : std::vector<Replayed>{},
      rules.confidence, priors.misfit);
  set_unlike(experiment, diagnosis);
  const auto hypotheses = corrected(weigh(readings.gap, readings.signatures, readings.together, priors),
                                    diagnosis.promise.correction);
  const Eigen::Index directions = ReducedSpace(readings.gap, readings.signatures).size();
  const AmbiguitySet set = set_of(hypotheses, diagnosis.promise.correction);
  diagnosis.ambiguity_set = set.ids, diagnosis.set_probability = set.probability;
  set_unseen(set, hypotheses, diagnosis);
  set_explanations(problem, set, within_range(hypotheses), directions, rules, plan, diagnosis);
  diagnosis.nearest_signature = nearest_signature(hypotheses, directions);
  const Hypothesis& best = hypotheses.front();
  diagnosis.p_value = p_value_of(best.chi_squared, directions, readings.gap.dof);
  set_groups(problem, experiment, diagnosis);
  std::vector<std::size_t> all(experiment.observations.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Magnitudes fitted = fitted_magnitudes(problem, effects_in(best.id), all);
  for (const std::size_t index : truly_strained(readings, fitted))
    diagnosis.specimen_strains.push_back(experiment.observations[index].name);
  set_pulls(readings, fitted, experiment, diagnosis);
  set_law(experiment, plan, diagnosis);
  diagnosis.law_as_stated.assign(plan.as_stated.begin(), plan.as_stated.end());
}

}  // namespace pendular::diagnosis
