#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/kinds/features.h"
#include "diagnosis/kinds/simulated.h"

namespace pendular::diagnosis {

/// The tests of one simulation, one per condition; empty where its run failed or was not made. Banks that are
/// made of another's runs share them.
using SimulatedTests = std::vector<std::shared_ptr<const SimulatedTest>>;

/// What an experiment shows: its features, and the observation of each.
struct ObservedFeatures {
  Level level = Level::landmarks;
  std::vector<Feature> features;
  std::vector<std::size_t> observation;
  Eigen::MatrixXd measurement;  ///< covariance of the measurement's errors, as features are compared
  Eigen::MatrixXd model;        ///< likewise of the simulation's own

  Eigen::VectorXd values() const;           ///< as they are compared
  double sigma(std::size_t feature) const;  ///< of the measurement
};
ObservedFeatures observed_features(Level level, const Experiment& experiment);

/// BadInput where the observations show no feature at all: before runs are made for them.
void require_features(const Experiment& experiment);

/// Those of `kept`, in that order.
ObservedFeatures subset(const ObservedFeatures& all, const std::vector<std::size_t>& kept);

/// The columns of one observation as simulated; nothing where a run that it needs failed.
std::optional<Columns> simulated_columns(const Experiment& experiment,
                                         const std::vector<Condition>& conditions, std::size_t observation,
                                         const SimulatedTests& tests, const Changes& changes);

/// The features as simulated, as they are compared; NaN where the simulation does not show one.
Eigen::VectorXd simulated_features(const Experiment& experiment, const std::vector<Condition>& conditions,
                                   const ObservedFeatures& observed, const SimulatedTests& tests,
                                   const Changes& changes);

}  // namespace pendular::diagnosis
