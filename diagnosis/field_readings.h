#pragma once

#include <optional>

#include "diagnosis/feature_values.h"
#include "diagnosis/field_statistics.h"

namespace pendular::diagnosis {

/// The fields of one observation, of the experiment and of a bank, as readings.
struct FieldReadings {
  std::vector<Feature> observed;
  Eigen::MatrixXd model;                 ///< covariance of what the simulation may be off by
  std::vector<Eigen::VectorXd> of_runs;  ///< per point of the plan; NaN where it has no field
  Eigen::VectorXd by_noise;              ///< what an error of a fifth in the stated errors does
};

/// Simulated fields get noise of the stated size, seeded by their place in the plan. Nothing where the beads of
/// the specimen were not measured, or no baseline has a field.
std::optional<FieldReadings> field_readings(const Experiment& experiment, const BankPlan& plan,
                                            std::size_t observation,
                                            const std::vector<SimulatedTests>& tests);

}  // namespace pendular::diagnosis
