#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "diagnosis/evidence.h"

namespace pendular::diagnosis {

/// The features of one simulated set of tests. Runs of one member start from the same beads with the same
/// seed.
struct DesignRun {
  int member = 0;
  std::string id;          ///< of the effect or the believed input that was changed; empty: none
  double theta = 0.0;      ///< by how much
  Eigen::VectorXd values;  ///< logarithms where compared so; NaN where the run does not show a feature
};

/// What a whole design of runs tells: value = member's offset + Σ θ^k c_k of what was changed + scatter.
struct Responses {
  std::vector<int> members;
  Eigen::MatrixXd offsets;            ///< a row per member: the features without any change
  std::vector<Signature> signatures;  ///< of each id in the order of its first run; range and scale unset
  Eigen::MatrixXd within, between;    ///< covariance of the scatter about the fit, and of the members
  double freedom = 0.0;               ///< of the scatter

  const Signature* find(const std::string& id) const;
};

/// One least-squares fit per feature over all runs that show it; a quadratic in θ for an id with three or
/// more magnitudes, a line for one with fewer. An id whose runs do not show a feature has no response there.
Responses fit_responses(const std::vector<DesignRun>& runs, Eigen::Index features);

/// Coefficients of a polynomial through zero, of as high a degree as `degree` and the magnitudes allow, for
/// changes that have no scatter: one change (a vector of features) per θ.
Signature exact_signature(const std::string& id, const std::vector<double>& theta,
                          const std::vector<Eigen::VectorXd>& changes, int degree);

/// Covariance of an observed specimen about the mean of the simulated ones, (1 + 1/R) of what lies between R
/// members and the scatter of the specimen and of the fit; drawn to its diagonal by p/(p + degrees of
/// freedom), so that few runs do not pretend to know correlations. Degrees of freedom by Welch and
/// Satterthwaite.
struct Scatter {
  Eigen::MatrixXd covariance;
  double freedom = 0.0;
};
Scatter scatter_of(const Responses& responses);

}  // namespace pendular::diagnosis
