#include "diagnosis/bank/feature_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "diagnosis/bank/contact_features.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis {
namespace {

constexpr int kRounds = 300;  // of perturbation, for the measurement's standard errors

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

/// From the scatter of perturbed columns; of few rounds, so drawn a little to its diagonal.
Eigen::MatrixXd measurement_covariance(Level level, const Observation& observation,
                                       const std::vector<Feature>& features, unsigned long seed) {
  const auto size = static_cast<Eigen::Index>(features.size());
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(kRounds, size);
  for (int round = 0; round < kRounds; ++round) {
    const auto again = features_of(
        level, observation,
        observation.kind->perturbed(observation, seed + 0x100 * static_cast<unsigned long>(round)));
    for (const auto& feature : again)
      for (std::size_t k = 0; k < features.size(); ++k)
        if (features[k].name == feature.name)
          changes(round, static_cast<Eigen::Index>(k)) = feature.compared() - features[k].compared();
  }
  const Eigen::MatrixXd centred = changes.rowwise() - changes.colwise().mean();
  Eigen::MatrixXd covariance = centred.transpose() * centred / (kRounds - 1.0);
  const Eigen::VectorXd diagonal = covariance.diagonal();
  covariance *= kRounds / (kRounds + static_cast<double>(size));
  covariance.diagonal() = diagonal;
  return covariance;
}

Eigen::MatrixXd block_diagonal(const std::vector<Eigen::MatrixXd>& blocks) {
  Eigen::Index size = 0;
  for (const auto& block : blocks) size += block.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index at = 0;
  for (const auto& block : blocks) {
    all.block(at, at, block.rows(), block.rows()) = block;
    at += block.rows();
  }
  return all;
}

}  // namespace

Eigen::VectorXd ObservedFeatures::values() const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(features.size()));
  for (std::size_t k = 0; k < features.size(); ++k)
    all[static_cast<Eigen::Index>(k)] = features[k].compared();
  return all;
}

double ObservedFeatures::sigma(std::size_t feature) const {
  const auto at = static_cast<Eigen::Index>(feature);
  return std::sqrt(measurement(at, at));
}

ObservedFeatures observed_features(Level level, const Experiment& experiment) {
  ObservedFeatures all;
  all.level = level;
  std::vector<Eigen::MatrixXd> measurement, model;
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    const Observation& observation = experiment.observations[index];
    const auto features = features_of(level, observation, observation.columns);
    if (features.empty()) continue;
    measurement.push_back(measurement_covariance(level, observation, features, index + 1));
    model.push_back(observation.kind->model_error(features));
    all.features.insert(all.features.end(), features.begin(), features.end());
    all.observation.resize(all.features.size(), index);
  }
  if (experiment.contacts)
    for (const auto& seen : contact_features(*experiment.contacts)) {
      all.features.push_back(seen.feature);
      all.observation.push_back(of_beads(experiment));
      measurement.push_back(Eigen::MatrixXd::Constant(1, 1, seen.sigma * seen.sigma));
      model.push_back(Eigen::MatrixXd::Zero(1, 1));
    }
  all.measurement = block_diagonal(measurement);
  all.model = block_diagonal(model);
  return all;
}

ObservedFeatures subset(const ObservedFeatures& all, const std::vector<std::size_t>& kept) {
  ObservedFeatures chosen;
  chosen.level = all.level;
  for (const std::size_t k : kept) {
    chosen.features.push_back(all.features[k]);
    chosen.observation.push_back(all.observation[k]);
  }
  const std::vector<Eigen::Index> rows(kept.begin(), kept.end());
  chosen.measurement = all.measurement(rows, rows);
  chosen.model = all.model(rows, rows);
  return chosen;
}

std::optional<Columns> simulated_columns(const Experiment& experiment,
                                         const std::vector<Condition>& conditions, std::size_t index,
                                         const SimulatedTests& tests, const Changes& changes) {
  const Observation& observation = experiment.observations[index];
  const Kind& kind = *observation.kind;
  if (kind.of_bridges)
    return kind.simulate(observation,
                         {changed_condition(experiment, without_test(experiment, index), changes)});
  if (!kind.simulate) return series_columns(experiment, conditions, index, tests);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    const auto& answers = conditions[c].observations;
    if (std::find(answers.begin(), answers.end(), index) == answers.end()) continue;
    if (!tests[c]) return std::nullopt;
    return kind.simulate(observation,
                         {changed_condition(experiment, conditions[c], changes), tests[c].get()});
  }
  return std::nullopt;
}

void require_features(const Experiment& experiment) {
  for (const auto& observation : experiment.observations)
    if (!features_of(Level::landmarks, observation, observation.columns).empty()) return;
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
        values[static_cast<Eigen::Index>(k)] = feature.compared();
  };
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    if (const auto columns = simulated_columns(experiment, conditions, index, tests, changes))
      for (const auto& feature : features_of(observed.level, experiment.observations[index], *columns))
        show(feature, index);
  }
  if (experiment.contacts)
    for (const auto& expected : contact_features(expected_contacts(*experiment.contacts, changes)))
      show(expected.feature, of_beads(experiment));
  return values;
}

}  // namespace pendular::diagnosis
