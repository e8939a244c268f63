#include "diagnosis/advice/next_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "diagnosis/bank/design.h"
#include "diagnosis/experiment/further_measurements.h"
#include "diagnosis/inference/calibration.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSpacing = 1.0 / 6.0;  // of magnitudes in a bank, over its largest
constexpr double kOfInterval = 3.29;    // standard deviations in an interval of 90 %
constexpr double kRound = 2.0;          // cost of another round, whatever is measured in it
constexpr double kBits = 0.1;           // what a bit is worth beside settling
constexpr double kCases = 240.0;        // replayed at least

bool same(const Condition& a, const Condition& b) {
  return a.beads == b.beads && a.network == b.network && sample_text(a.sample) == sample_text(b.sample);
}

/// An experiment over what a bank has, and what must be run beside it.
class Prospect {
 public:
  Prospect(const BankInHand& bank, Experiment experiment, const std::set<std::string>& effects)
      : bank_(bank), experiment_(std::move(experiment)) {
    plan_.conditions = conditions_of(experiment_);
    plan_.size = sizes_of(plan_.conditions);
    plan_.absent = bank.plan.absent;
    for (const auto& effect : effects::all_effects())
      if (!effects.contains(effect.id)) plan_.absent.emplace(effect.id, "not in question");
    for (std::size_t k = 0; k < bank.plan.points.size(); ++k) {
      const DesignPoint& point = bank.plan.points[k];
      if (point.at_fit || point.changes.size() > 1 || (is_effect(point) && !effects.contains(point.id)))
        continue;
      plan_.points.push_back(point);
      tests_.push_back(known_tests(k));
    }
  }

  bool made() const { return runs_.empty(); }

  /// Runs that were not made, or failed.
  std::size_t missing() const { return runs_.size() + failed_; }

  /// Makes what is missing, where all of it may be made.
  void make(const std::string& name, std::vector<LedgerRow>& ledger) {
    if (made() || !may_be_made()) return;
    std::vector<sweep::RunRequest> requests;
    for (const auto& [point, condition] : runs_) {
      const DesignPoint& of = plan_.points[point];
      requests.push_back(request_of(experiment_, plan_.conditions[condition], of.member, of.seed, of.changes,
                                    bank_.packings, of.whole ? 1.0 : plan_.size[condition]));
    }
    const auto outcomes = (*bank_.make_runs)(name, requests);
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      const auto& [point, condition] = runs_[k];
      const Changes& changes = plan_.points[point].changes;
      book_run(outcomes[k], condition, name + ": ", changes, ledger);
      tests_[point][condition] = read_run(outcomes[k], changes);
      failed_ += !tests_[point][condition];
    }
    runs_.clear();
  }

  /// Every run diagnosed with all that the experiment has; nothing where no run shows what was added.
  std::vector<Replayed> replayed() {
    for (std::size_t index = bank_.measured; index < experiment_.observations.size(); ++index) {
      const auto columns = as_believed(index);
      if (!columns) return {};
      show(experiment_.observations[index], *columns);
    }
    const auto [plan, tests] = with_readings(plan_, tests_);
    const BankFeatures features(Level::readings, experiment_, plan, tests);
    double runs = 0.0;
    for (const auto& point : plan.points) runs += point.id.empty() || is_effect(point);
    return replay(experiment_, plan, features, bank_.priors, static_cast<int>(std::ceil(kCases / runs)));
  }

 private:
  bool may_be_made() const {
    return bank_.make_runs && std::all_of(runs_.begin(), runs_.end(), [&](const BankPlan::Run& run) {
             return plan_.conditions[run.condition].sample.compression.max_strain <= bank_.farthest;
           });
  }

  static bool is_effect(const DesignPoint& point) { return effects::known_effect(point.id) != nullptr; }

  /// The tests of a point that the bank has; the others are asked for.
  SimulatedTests known_tests(std::size_t point) {
    SimulatedTests tests(plan_.conditions.size());
    const DesignPoint& of = bank_.plan.points[point];
    for (std::size_t c = 0; c < plan_.conditions.size(); ++c) {
      const auto& all = bank_.plan.conditions;
      const auto found = std::find_if(all.begin(), all.end(),
                                      [&](const Condition& one) { return same(one, plan_.conditions[c]); });
      if (found != all.end()) {
        tests[c] = bank_.tests[point][static_cast<std::size_t>(found - all.begin())];
      } else if (!of.scans_only || ends_at_scan(plan_.conditions[c])) {
        runs_.push_back({plan_.points.size() - 1, c});
      }
    }
    return tests;
  }

  std::optional<Columns> as_believed(std::size_t observation) const {
    for (std::size_t k = 0; k < plan_.points.size(); ++k)
      if (plan_.points[k].id.empty() && plan_.points[k].whole)
        if (auto columns = simulated_columns(experiment_, plan_.conditions, observation, tests_[k], {}))
          return columns;
    return std::nullopt;
  }

  const BankInHand& bank_;
  Experiment experiment_;
  BankPlan plan_;
  std::vector<SimulatedTests> tests_;
  std::vector<BankPlan::Run> runs_;  // to be made
  std::size_t failed_ = 0;
};

/// How likely a magnitude is by what is known of it, at the resolution of a bank.
double likelihood(const Magnitude& known, double theta) {
  const double width = (known.interval_90.second - known.interval_90.first) / kOfInterval;
  const double largest = std::max(std::fabs(known.interval_90.first), std::fabs(known.interval_90.second));
  const double sd = std::hypot(width, kSpacing * largest);
  return std::exp(-0.5 * std::pow((theta - known.mean) / sd, 2));
}

/// Of runs of one truth, that share its probability.
std::function<double(const Replayed&)> weights_of(const std::vector<Replayed>& replayed,
                                                  const Question& question) {
  const auto closeness = [&question](const Replayed& one) {
    const auto known = question.magnitudes.find(truth_of(one));
    return known == question.magnitudes.end() || one.truth.empty()
               ? 1.0
               : likelihood(known->second, one.truth.begin()->second);
  };
  std::map<std::string, double> sums;
  for (const auto& one : replayed)
    if (one.truth.size() < 2) sums[truth_of(one)] += closeness(one);
  return [sums, closeness, &question](const Replayed& one) {
    const auto probability = question.probabilities.find(truth_of(one));
    const double sum = sums.at(truth_of(one));
    return probability == question.probabilities.end() || sum <= 0.0
               ? 0.0
               : probability->second * closeness(one) / sum;
  };
}

Outlook outlook(const std::vector<Replayed>& replayed, const Question& question, double confidence) {
  return outlook_of(replayed, confidence, weights_of(replayed, question));
}

bool settles_something(const FurtherMeasurement& measurement, const Question& question) {
  return std::any_of(measurement.settles.begin(), measurement.settles.end(),
                     [&](const std::string& id) { return question.effects.contains(id); });
}

/// Bits gained where the effects of a measurement that tells for sure are found, each by itself, or ruled
/// out.
double gain_of(const FurtherMeasurement& measurement, const Question& question) {
  double sum = 0.0, left = 0.0, bits = 0.0;
  for (const auto& [id, probability] : question.probabilities) sum += probability;
  const auto term = [&](double share) { return share > 0.0 ? -share * std::log2(share) : 0.0; };
  for (const auto& [id, probability] : question.probabilities)
    if (measurement.settles.contains(id))
      bits += term(probability / sum);
    else
      left += probability / sum;
  return bits + term(left);
}

/// Best value first; those that lack runs last.
void rank(NextSteps& steps) {
  const auto value = [&](const NextExperiment& next) {
    return (next.outlook.settled - steps.now.settled + kBits * next.gain) / (kRound + next.cost);
  };
  const auto better = [&](const NextExperiment& a, const NextExperiment& b) {
    const bool known_a = a.outlook.cases > 0, known_b = b.outlook.cases > 0;
    return known_a != known_b ? known_a : known_a && value(a) > value(b);
  };
  std::stable_sort(steps.experiments.begin(), steps.experiments.end(), better);
}

}  // namespace

Question question_after(const Diagnosis& diagnosis) {
  Question question;
  const auto& set = diagnosis.ambiguity_set;
  for (const auto& e : diagnosis.explanations) {
    const bool in =
        e.probability >= kThresholds.in_question || std::find(set.begin(), set.end(), e.id) != set.end();
    if (!in || e.excluded || e.id == "unknown") continue;
    if (e.id == "none") question.probabilities["none"] = e.probability;
    for (const auto& id : effects_in(e.id)) question.effects.insert(id);
  }
  for (const auto& e : diagnosis.explanations)
    if (question.effects.contains(e.id)) {
      question.probabilities[e.id] = e.probability;
      question.magnitudes[e.id] = e.magnitudes.front();
    }
  return question;
}

bool is_settled(const Diagnosis& diagnosis) {
  const auto& set = diagnosis.ambiguity_set;
  if (set.empty()) return true;
  if (set.size() > 1 || diagnosis.explanations.front().probability < kThresholds.likely) return false;
  return set.front() != "none" || question_after(diagnosis).effects.empty();
}

Question question_before(const BankPlan& plan, const std::set<std::string>& about) {
  Question question;
  question.probabilities["none"] = 1.0;
  for (const auto& effect : effects::all_effects()) {
    if (plan.absent.contains(effect.id)) continue;
    question.effects.insert(effect.id);
    if (about.empty() || about.contains(effect.id)) question.probabilities[effect.id] = 1.0;
  }
  return question;
}

std::vector<Replayed> replayed_with(const BankInHand& bank, const Experiment& experiment,
                                    const std::set<std::string>& effects, const std::string& name,
                                    std::vector<LedgerRow>& ledger) {
  Prospect prospect(bank, experiment, effects);
  prospect.make(name, ledger);
  return prospect.made() ? prospect.replayed() : std::vector<Replayed>{};
}

NextSteps next_steps(const BankInHand& bank, const Question& question, std::vector<LedgerRow>& ledger) {
  NextSteps steps;
  const auto now = replayed_with(bank, bank.experiment, question.effects, "experiment", ledger);
  steps.now = outlook(now, question, bank.confidence);
  if (steps.now.cases == 0) return steps;
  for (const auto& measurement : further_measurements()) {
    NextExperiment next{measurement.name, measurement.why, measurement.cost};
    if (!measurement.added) {
      if (!settles_something(measurement, question)) continue;
      next.outlook = outlook(knowing(now, measurement.settles), question, bank.confidence);
    } else if (auto more = measurement.added(bank.experiment)) {
      Prospect prospect(bank, std::move(*more), question.effects);
      prospect.make(measurement.name, ledger);
      if (prospect.made()) next.outlook = outlook(prospect.replayed(), question, bank.confidence);
      if (next.outlook.cases == 0) next.runs = prospect.missing();
    } else {
      continue;
    }
    next.gain = !measurement.added       ? gain_of(measurement, question)
                : next.outlook.cases > 0 ? steps.now.entropy - next.outlook.entropy
                                         : 0.0;
    if (next.runs > 0 || next.gain > kThresholds.gain) steps.experiments.push_back(std::move(next));
  }
  rank(steps);
  return steps;
}

}  // namespace pendular::diagnosis
