#pragma once

#include <vector>

#include "diagnosis/inference/evidence.h"
#include "diagnosis/kinds/features.h"

namespace pendular::diagnosis {

/// What makes up the noise of one feature: standard deviations.
struct NoiseBudget {
  double ensemble = 0.0, measurement = 0.0, model = 0.0, believed = 0.0;
};

/// Where observation and simulation part: one feature.
struct GapRow {
  Feature observed;
  double simulated = 0.0;
  double difference = 0.0;   ///< simulated against observed: logarithm of the ratio, or difference
  double sigma = 0.0;        ///< of the difference, believed inputs included
  double z = 0.0;            ///< difference over sigma
  bool significant = false;  ///< with all features looked at together, at 5 %
  double share = 0.0;        ///< of the gap that goes when this feature is left out; sums to one
};

/// The whole gap, and what of it is noise.
struct GapTable {
  std::vector<GapRow> rows;
  double distance = 0.0;     ///< root mean square of the features in units of their joint noise
  double excess = 0.0;       ///< √max(0, distance² − 1)
  double noise_floor = 0.0;  ///< median sigma of the features compared by ratio: what cannot be seen
  double threshold = 0.0;    ///< |z| from which a feature is significant
};

/// The observed features beside the simulated ones, in the order of `gap`, whose covariance and believed
/// inputs they share. The threshold is the 95 % quantile of the largest |z| of features that differ by noise
/// alone, with their correlations (Westfall & Young 1993), from seeded draws.
GapTable gap_table(const std::vector<Feature>& observed, const std::vector<double>& simulated,
                   const Gap& gap);

/// Of all noise, believed inputs included.
Eigen::MatrixXd whole_covariance(const Gap& gap);

/// √max(0, gᵀ C⁻¹ g / p − 1) of a gap, believed inputs floating.
double excess(const Gap& gap);

}  // namespace pendular::diagnosis
