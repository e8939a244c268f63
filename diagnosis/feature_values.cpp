#include "diagnosis/feature_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "diagnosis/contact_features.h"

namespace pendular::diagnosis {
namespace {

constexpr int kRounds = 200;  // of perturbation, for the measurement's standard errors

double compared(const Feature& feature) {
  return feature.logarithm ? std::log(feature.value) : feature.value;
}

bool of_bridges(Kind kind) {
  return kind == Kind::bridge_stiffness || kind == Kind::bridge_diameters || kind == Kind::bridge_gaps;
}

/// The condition as single-bridge tests know it: the sample as the observation states it.
Condition without_test(const Experiment& experiment, std::size_t observation) {
  return {experiment.sample_of(experiment.observations[observation]), {}, {observation}};
}

std::optional<Columns> series_columns(const Experiment& experiment, const std::vector<Condition>& conditions,
                                      std::size_t index, const SimulatedTests& tests) {
  const Observation& observation = experiment.observations[index];
  const auto& at = observation.column(observation.has("W") ? "W" : "E_p_pa");
  std::vector<SeriesPoint> points;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    if (conditions[c].observations != std::vector{index}) continue;
    if (!tests[c]) return std::nullopt;
    points.push_back({at[conditions[c].row], simulated_modulus(*tests[c])});
    if (!std::isfinite(points.back().modulus)) return std::nullopt;
  }
  return columns_of_series(observation, points);
}

/// The first observation of a specimen whose beads were measured.
std::size_t of_beads(const Experiment& experiment) {
  std::size_t index = 0;
  while (experiment.observations[index].beads.empty()) ++index;
  return index;
}

}  // namespace

Eigen::VectorXd ObservedFeatures::values() const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(features.size()));
  for (std::size_t k = 0; k < features.size(); ++k) all[static_cast<Eigen::Index>(k)] = compared(features[k]);
  return all;
}

ObservedFeatures observed_features(const Experiment& experiment) {
  ObservedFeatures all;
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    const Observation& observation = experiment.observations[index];
    const auto features = features_of(observation, observation.columns);
    const auto sigmas = feature_sigmas(observation, kRounds, index + 1);
    all.features.insert(all.features.end(), features.begin(), features.end());
    all.sigmas.insert(all.sigmas.end(), sigmas.begin(), sigmas.end());
    all.observation.resize(all.features.size(), index);
  }
  if (!experiment.contacts) return all;
  for (const auto& seen : contact_features(*experiment.contacts)) {
    all.features.push_back(seen.feature);
    all.sigmas.push_back(seen.sigma);
    all.observation.push_back(of_beads(experiment));
  }
  return all;
}

ObservedFeatures subset(const ObservedFeatures& all, const std::vector<std::size_t>& kept) {
  ObservedFeatures chosen;
  for (const std::size_t k : kept) {
    chosen.features.push_back(all.features[k]);
    chosen.observation.push_back(all.observation[k]);
    chosen.sigmas.push_back(all.sigmas[k]);
  }
  return chosen;
}

std::optional<Columns> simulated_columns(const Experiment& experiment,
                                         const std::vector<Condition>& conditions, std::size_t index,
                                         const SimulatedTests& tests, const Changes& changes) {
  const Observation& observation = experiment.observations[index];
  if (of_bridges(observation.kind))
    return columns_of_bridges(observation,
                              changed_condition(experiment, without_test(experiment, index), changes));
  if (observation.kind == Kind::modulus_series) return series_columns(experiment, conditions, index, tests);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    const auto& answers = conditions[c].observations;
    if (std::find(answers.begin(), answers.end(), index) == answers.end()) continue;
    if (!tests[c]) return std::nullopt;
    return columns_of_test(observation, *tests[c]);
  }
  return std::nullopt;
}

void require_features(const Experiment& experiment) {
  for (const auto& observation : experiment.observations)
    if (!features_of(observation, observation.columns).empty()) return;
  bad_input(
      "{}: the observations show nothing that can be compared, expected e.g. a compression that shows its "
      "linear part",
      experiment.name);
}

Eigen::VectorXd simulated_features(const Experiment& experiment, const std::vector<Condition>& conditions,
                                   const ObservedFeatures& observed, const SimulatedTests& tests,
                                   const Changes& changes) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(observed.features.size()),
                                                     std::numeric_limits<double>::quiet_NaN());
  const auto show = [&](const Feature& feature, std::size_t index) {
    for (std::size_t k = 0; k < observed.features.size(); ++k)
      if (observed.observation[k] == index && observed.features[k].name == feature.name)
        values[static_cast<Eigen::Index>(k)] = compared(feature);
  };
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    if (const auto columns = simulated_columns(experiment, conditions, index, tests, changes))
      for (const auto& feature : features_of(experiment.observations[index], *columns)) show(feature, index);
  }
  if (experiment.contacts)
    for (const auto& expected : contact_features(expected_contacts(*experiment.contacts, changes)))
      show(expected.feature, of_beads(experiment));
  return values;
}

}  // namespace pendular::diagnosis
