#pragma once

#include <optional>
#include <vector>

#include "diagnosis/bank/feature_values.h"
#include "diagnosis/kinds/field_statistics.h"

namespace pendular::diagnosis {

/// The fields of one observation, of beads that at least three bonds to such beads hold: as measured, and of
/// every run of a bank. µm, scan after scan.
struct FieldBank {
  std::string observation;
  std::vector<FollowedBeads> scans;
  Eigen::VectorXd measured;
  std::vector<std::optional<Eigen::VectorXd>> of_runs;  ///< per point of the plan; empty: it has none
};

/// Nothing where the beads of the specimen were not measured, fewer of them are held than a scan needs, or no
/// baseline has a field.
std::optional<FieldBank> field_bank(const Experiment& experiment, const BankPlan& plan,
                                    std::size_t observation, const std::vector<SimulatedTests>& tests);

/// Reads fields as numbers (FieldStatistics), learnt from the runs of a bank but those of one member.
class FieldReader {
 public:
  /// `points`: of the plan; `but`: a member, or 0. At least one other member must have a baseline.
  FieldReader(const FieldBank& bank, const std::vector<DesignPoint>& points, int but = 0);

  std::vector<Feature> measured(const FieldBank& bank) const;
  /// A field, µm, as the numbers that measured() names.
  Eigen::VectorXd read(const Eigen::VectorXd& field) const;
  /// Seeded noise of the stated size for a field, µm.
  Eigen::VectorXd noise(unsigned long seed) const;
  /// The runs' fields, those of one member with the same noise; NaN where a run has none.
  std::vector<Eigen::VectorXd> of_runs(const FieldBank& bank, const std::vector<DesignPoint>& points) const;

  /// What an error of a fifth in the stated errors does to the readings.
  Eigen::VectorXd by_noise(const FieldBank& bank, const std::vector<DesignPoint>& points) const;

 private:
  int but_;
  std::vector<FieldStatistics> statistics_;  // of each scan
};

/// Covariance of what the simulation may be off by in readings of fields, from those of the baselines.
Eigen::MatrixXd field_model_error(const std::vector<Eigen::VectorXd>& baselines);

}  // namespace pendular::diagnosis
