#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "diagnosis/evidence.h"

namespace pendular::diagnosis {

/// A run with an effect beside the run without it on the same packing and with the same seed.
struct PairedRun {
  double theta = 0.0;
  Eigen::VectorXd change;  ///< of the features; NaN where one of both runs does not show a feature
};

/// An effect's signature, and what the runs leave of it.
struct FittedSignature {
  Signature signature;
  Eigen::MatrixXd residuals;  ///< a row per run; zero where a run does not show a feature
  double freedom = 0.0;       ///< runs less parameters of the features' fits, on average
};

/// Least squares of change = θ linear + θ² curved, for each feature by itself over the runs that show it; a
/// straight line where they have fewer than three magnitudes, nothing where they have none. Range and scale
/// of the signature are left to the caller.
FittedSignature fit_signature(const std::string& id, const std::vector<PairedRun>& runs,
                              Eigen::Index features);

/// Covariance of the features from residuals of several fits and of the baseline about its mean, drawn to
/// its diagonal by p/(p + degrees of freedom), so that few runs do not pretend to know correlations.
struct PooledCovariance {
  Eigen::MatrixXd covariance;
  double freedom = 0.0;
};
PooledCovariance pooled_covariance(const std::vector<Eigen::MatrixXd>& residuals, double freedom);

}  // namespace pendular::diagnosis
