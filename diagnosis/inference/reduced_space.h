#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include "diagnosis/bank/signature.h"

namespace pendular::diagnosis {

/// A gap in a reduced space: its coordinates within the span of all responses, and the square of what is
/// outside.
struct ReducedGap {
  Eigen::VectorXd within;
  double outside = 0.0;
};

/// How a reduced response is known, besides the noise.
struct Errors {
  Eigen::VectorXd shares;  ///< variances, of what is a share of the response
  Eigen::MatrixXd draws;   ///< covariance of what runs of it differ by
  double dof = 0.0;        ///< degrees of freedom of that; 0: it is known
  double outside = 0.0;    ///< square outside the span
};

/// What an explanation says of a gap: the response, the factor of its covariance, noise included, degrees of
/// freedom of that, minus the logarithm of the density at its peak, and by how much errors widen what is
/// outside the span.
struct Prediction {
  Eigen::VectorXd response;
  Eigen::LLT<Eigen::MatrixXd> factor;
  double dof = 0.0, log_volume = 0.0, widening = 1.0;
};

/// How well a prediction fits: logarithm of the density, and Mahalanobis distance squared.
struct Fit {
  double log_likelihood = 0.0, chi_squared = 0.0;
};

/// Features in units of their noise, believed inputs included, reduced to the directions that responses of
/// all effects span beyond it. What lies outside is kept as one number, its square.
class ReducedSpace {
 public:
  ReducedSpace(const Gap& gap, const std::vector<Signature>& signatures);

  Eigen::VectorXd reduced(const Eigen::VectorXd& v) const { return reducer_ * v; }
  Eigen::MatrixXd reduced_covariance(const Eigen::MatrixXd& covariance) const {
    return reducer_ * covariance * reducer_.transpose();
  }
  Signature reduced(Signature signature) const;
  ReducedGap gap(const Eigen::VectorXd& values) const { return {reduced(values), outside(values)}; }
  Eigen::Index size() const { return reducer_.rows(); }
  /// The square of what is outside the span.
  double outside(const Eigen::VectorXd& v) const;

  Prediction predict(const Eigen::VectorXd& response, const Errors& errors) const;

  /// The density is the multivariate t of Sellentin & Heavens (2016, MNRAS 456, L132).
  Fit fit(const ReducedGap& gap, const Prediction& prediction) const;

  /// The log-likelihood of a χ² where the noise's standard deviation is so many times as large
  /// within the span, and outside it.
  double widened(const ReducedGap& gap, const Prediction& prediction, double chi_squared, double within,
                 double outside) const;

 private:
  Eigen::VectorXd whiten(const Eigen::VectorXd& v) const { return factor_.matrixL().solve(v); }
  void reduce(Response& response) const;
  void find_directions(const std::vector<Signature>& signatures);
  void learn_outside(const std::vector<double>& known);
  double log_outside(double outside, double factor) const;

  Eigen::LLT<Eigen::MatrixXd> factor_;  // of the noise's covariance
  Eigen::MatrixXd precision_;           // its inverse
  double dof_;
  Eigen::MatrixXd reducer_;  // whitens, and takes what is along orthonormal directions
  double dimensions_ = 0.0;  // outside the span
  double outside_scale_ = 1.0, outside_dof_ = 1.0;
  double log_chi_ = 0.0;  // normalisation of the density outside
};

}  // namespace pendular::diagnosis
