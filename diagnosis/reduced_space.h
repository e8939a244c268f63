#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include "diagnosis/signature.h"

namespace pendular::diagnosis {

/// Features in units of their noise, believed inputs included, reduced to the directions that responses of all
/// effects span beyond it. What lies outside is kept as one number, its square.
class ReducedSpace {
 public:
  ReducedSpace(const Gap& gap, const std::vector<Signature>& signatures);

  Eigen::VectorXd reduced(const Eigen::VectorXd& v) const { return directions_.transpose() * whiten(v); }
  Signature reduced(Signature signature) const;
  const Eigen::VectorXd& values() const { return values_; }
  Eigen::Index size() const { return values_.size(); }
  /// The square of what is outside the span.
  double outside(const Eigen::VectorXd& v) const;

  /// How well a response fits: logarithm of the density, Mahalanobis distance squared, half the logarithm of the
  /// covariance's determinant, and by how much its errors widen what is outside the span.
  struct Fit {
    double log_likelihood = 0.0, misfit = 0.0, log_volume = 0.0, widening = 1.0;
  };

  /// Of what a response leaves, where the response has this covariance besides the noise, and this square outside
  /// the span. The density is the multivariate t of Sellentin & Heavens (2016, MNRAS 456, L132).
  Fit fit(const Eigen::VectorXd& response, const Eigen::MatrixXd& covariance, double outside) const;

  /// The log-likelihood where the noise's standard deviation is so many times as large within the span, and
  /// outside it.
  double widened(const Fit& fit, double within, double outside) const;

 private:
  Eigen::VectorXd whiten(const Eigen::VectorXd& v) const { return factor_.matrixL().solve(v); }
  void reduce(Response& response) const;
  void find_directions(const std::vector<Signature>& signatures);
  void learn_outside(const std::vector<double>& known);
  double log_outside(double factor) const;
  double density(double squared, double log_volume) const;

  Eigen::LLT<Eigen::MatrixXd> factor_;
  double freedom_;
  Eigen::MatrixXd directions_;  // orthonormal columns in the whitened features
  Eigen::VectorXd values_;
  double outside_ = 0.0, dimensions_ = 0.0;  // of the gap; outside the span
  double outside_scale_ = 1.0, outside_freedom_ = 1.0;
};

}  // namespace pendular::diagnosis
