#include "diagnosis/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/quantity.h"
#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/bank/bank_tests.h"
#include "diagnosis/inference/leading.h"
#include "diagnosis/inference/stated_laws.h"
#include "diagnosis/repair/experiment_places.h"
#include "diagnosis/repair/shrinkage.h"
#include "diagnosis/thresholds.h"
#include "diagnosis/verdict.h"
#include "diagnosis/words.h"

namespace pendular::diagnosis {
namespace {

constexpr int kRounds = 6;  // of runs at the leading explanations

/// The problem as the bank shows it once nothing new leads, or nothing more may be run.
Problem followed_problem(const Experiment& experiment, MemberPackings& packings, const Rules& rules,
                         BankPlan& plan, BankTests& bank) {
  bank.make("bank", plan);
  Problem problem = readings_of(experiment, plan, bank.tests());
  plan.as_stated = laws_as_stated(problem.readings, known_explanations(problem.readings, rules.priors));
  if (!plan.as_stated.empty()) compare_anew(experiment, plan, problem);
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = plan.requests.size();
    // What leads by itself comes first: two effects often do what one and wrong beliefs do together.
    const auto known = known_explanations(problem.readings, rules.priors);
    auto points = fitted_points(problem.readings, known, plan);
    if (points.empty()) points = leading_points(known, plan);
    add_points(experiment, points, packings, plan);
    const std::size_t added = plan.requests.size() - before;
    if (added == 0) break;
    plan.further -= static_cast<int>(added);
    bank.make("leading explanations", plan);
    problem = readings_of(experiment, plan, bank.tests());
  }
  add_landmarks(experiment, plan, bank.tests(), problem);
  return problem;
}

void add_overlays(const Experiment& experiment, const BankPlan& plan,
                  const std::vector<SimulatedTests>& tests, Diagnosis& diagnosis) {
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    const Observation& observation = experiment.observations[index];
    Overlay overlay{observation.name, observation.kind, observation.columns, {}, {}};
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      if (!plan.points[k].whole || !plan.points[k].id.empty()) continue;
      if (auto columns = simulated_columns(experiment, plan.conditions, index, tests[k], {}))
        overlay.simulated.push_back(std::move(*columns));
    }
    diagnosis.overlays.push_back(std::move(overlay));
  }
}

/// Observations of one specimen and test that do not agree with each other.
void warn_of_contradictions(const Experiment& experiment, const BankPlan& plan, Diagnosis& diagnosis) {
  const ObservedFeatures all = observed_features(Level::landmarks, experiment);
  const Eigen::VectorXd values = all.values();
  for (const auto& condition : plan.conditions)
    for (std::size_t a = 0; a < all.features.size(); ++a)
      for (std::size_t b = a + 1; b < all.features.size(); ++b) {
        const auto answers = [&](std::size_t f) {
          return std::find(condition.observations.begin(), condition.observations.end(),
                           all.observation[f]) != condition.observations.end();
        };
        if (all.observation[a] == all.observation[b] || all.features[a].name != all.features[b].name ||
            !answers(a) || !answers(b))
          continue;
        const double apart = values[static_cast<Eigen::Index>(a)] - values[static_cast<Eigen::Index>(b)];
        const double sigma =
            std::hypot(std::hypot(all.sigma(a), all.sigma(b)), all.features[a].logarithm ? 0.02 : 1e-3);
        if (std::fabs(apart) > kThresholds.contradiction * sigma)
          diagnosis.warnings.push_back(
              fmt::format("{} and {} are of one specimen and test but differ in {} by {:.1f} sigma: they "
                          "contradict each other",
                          all.features[a].observation, all.features[b].observation, all.features[a].name,
                          std::fabs(apart) / sigma));
      }
}

/// What the reader must know of the input.
void warn_of_input(const Experiment& experiment, Diagnosis& diagnosis) {
  diagnosis.warnings = experiment.warnings;
  for (const auto& [key, sd] : floating_inputs(experiment))
    if (!experiment.uncertainty.contains(key))
      diagnosis.warnings.push_back(
          fmt::format("no uncertainty of {} is stated: {} is assumed", key, quantity(sd, unit_of_key(key))));
  for (const auto& [key, sd] : experiment.uncertainty)
    if (sd == 0.0)
      diagnosis.warnings.push_back(fmt::format("{} is stated without any uncertainty: taken as exact", key));
  for (const auto& observation : experiment.observations)
    if (features_of(Level::landmarks, observation, observation.columns).empty())
      diagnosis.warnings.push_back(
          observation.name + " shows nothing that can be compared (a curve that never becomes linear?)");
}

}  // namespace

Diagnosis diagnose(const Experiment& experiment, BankPlan plan, const fs::path& beads_folder,
                   const MakeRuns& make_runs, const Rules& rules, const Scope& scope) {
  Diagnosis diagnosis;
  diagnosis.experiment = experiment.name;
  warn_of_input(experiment, diagnosis);
  warn_of_contradictions(experiment, plan, diagnosis);
  MemberPackings packings(beads_folder);
  BankTests bank(make_runs, diagnosis.ledger);
  const Problem problem = followed_problem(experiment, packings, rules, plan, bank);
  add_overlays(experiment, plan, bank.tests(), diagnosis);
  diagnosis.warnings.insert(diagnosis.warnings.end(), problem.warnings.begin(), problem.warnings.end());
  judge(problem, rules, plan, experiment, diagnosis);
  if (scope.say_cause) scope.say_cause(cause_of(diagnosis));
  if (diagnosis.promise.cases == 0)
    diagnosis.warnings.push_back(
        "the bank is too small to be replayed: how far probabilities, sets and intervals hold is not known, "
        "and they are wider by rule");
  if (scope.fresh_runs)
    measure_shrinkage({experiment, plan, problem, packings, make_runs}, diagnosis);
  else
    diagnosis.warnings.push_back(
        "how far the gap shrinks was not measured: no fresh runs were made, as asked");
  diagnosis.places = places_in(experiment, plan, packings, diagnosis.overlays, diagnosis.warnings);
  if (!is_settled(diagnosis)) {
    const BankInHand in_hand{experiment,
                             plan,
                             bank.tests(),
                             packings,
                             scope.plan || scope.fresh_runs ? &make_runs : nullptr,
                             scope.plan ? kAnyStrain : kThresholds.short_test,
                             rules.priors,
                             rules.confidence,
                             experiment.observations.size()};
    diagnosis.next = next_steps(in_hand, question_after(diagnosis), diagnosis.ledger);
  }
  diagnosis.verdict = verdict_of(diagnosis);
  return diagnosis;
}

Shrinkage closed_by(const Experiment& experiment, const BankPlan& plan, const fs::path& beads_folder,
                    const MakeRuns& make_runs, const Changes& changes) {
  Diagnosis books;
  MemberPackings packings(beads_folder);
  BankTests bank(make_runs, books.ledger);
  bank.make("bank", plan);
  const Problem problem = problem_of(experiment, plan, bank.tests());
  return shrinkage_by({experiment, plan, problem, packings, make_runs}, changes, books);
}

}  // namespace pendular::diagnosis
