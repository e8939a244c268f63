#pragma once

#include <Eigen/Core>

#include <set>
#include <string>
#include <vector>

#include "diagnosis/bank/signature.h"

namespace pendular::diagnosis {

/// The features of one simulated set of tests. Runs of one member start from the same beads.
struct DesignRun {
  int member = 0;
  std::string id;          ///< of the effect or the believed input that was changed; empty: none
  double theta = 0.0;      ///< by how much
  Eigen::VectorXd values;  ///< as they are compared; NaN where the run does not show a feature
  bool draws = false;      ///< what is changed differs from draw to draw
  bool exact = false;      ///< what is changed has no scatter: the same run, read otherwise
  bool sided = false;      ///< negative magnitudes have a response of their own
};

/// What a whole design of runs tells: value = member's baseline + Σ θ^k c_k of what was changed + scatter.
struct Responses {
  std::vector<int> members;
  Eigen::MatrixXd offsets;            ///< a row per member: the features without any change; NaN: not shown
  Eigen::VectorXd mean;               ///< of the members
  std::vector<Signature> signatures;  ///< of each id in the order of its first run; range and scale unset
  Eigen::MatrixXd within, between;    ///< covariance of the scatter about the fit, and of the members
  double dof = 0.0;                   ///< of the scatter

  const Signature* find(const std::string& id) const;
  /// A member's features without any change; the members' mean where those are not known.
  Eigen::VectorXd baseline(int member) const;
  /// Of one sign of an id, or of both.
  void add(const std::string& id, bool below, Response response);
};

/// Each run less the baseline of its member (the members' mean where that failed), fitted by a quadratic in θ
/// for an id with two or more magnitudes, with a logarithm beside it (Response) from four magnitudes and six
/// runs on, by a line for one with one; for each sign by itself where runs say so. What ids that do not draw
/// leave is the scatter; that by which a fit without it misses a run, beyond the scatter, is the response's
/// own covariance (Response::draws), which grows with the likeliest of some powers of θ. Covariances are over
/// the runs that show both features. Runs that a fit cannot follow count no more than three median
/// deviations.
Responses fit_responses(const std::vector<DesignRun>& runs, Eigen::Index features);

/// Covariance of an observed specimen about the mean of the simulated ones, (1 + 1/R) of what lies between R
/// members and the scatter of the specimen and of the fit; drawn to its diagonal, so that few runs do not
/// pretend to know correlations. Degrees of freedom by Welch and Satterthwaite.
struct Scatter {
  Eigen::MatrixXd covariance;
  double dof = 0.0;
};
Scatter scatter_of(const Responses& responses);

/// The nearest covariance without negative variances in any direction.
Eigen::MatrixXd positive_part(const Eigen::MatrixXd& covariance);

}  // namespace pendular::diagnosis
