#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "diagnosis/bank.h"
#include "diagnosis/features.h"
#include "diagnosis/simulated.h"

namespace pendular::diagnosis {

/// The tests of one simulation, one per condition; empty where its run failed.
using SimulatedTests = std::vector<std::optional<SimulatedTest>>;

/// What an experiment shows: its features, and the observation of each.
struct ObservedFeatures {
  std::vector<Feature> features;
  std::vector<std::size_t> observation;
  std::vector<double> sigmas;  ///< of the measurement, as they are compared

  /// As they are compared: logarithms or values.
  Eigen::VectorXd values() const;
};
ObservedFeatures observed_features(const Experiment& experiment);

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
