#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

#include "diagnosis/bank/signature.h"
#include "diagnosis/inference/lanes.h"

namespace pendular::diagnosis {

/// A gap in a reduced space: its coordinates within the span of all responses, and the square of what is
/// outside.
struct ReducedGap {
  Eigen::VectorXd within;
  double outside = 0.0, log_outside = 0.0;
};

/// A reduced response, and how it is known besides the noise.
struct Expected {
  Eigen::VectorXd response;
  Eigen::VectorXd shares;  ///< variances, of what is a share of the response
  /// What runs of it differ by: the sum of so many times these covariances, which are kept by reference.
  std::vector<std::pair<const Eigen::MatrixXd*, double>> draws = {};
  double dof = 0.0;            ///< degrees of freedom of that; 0: it is known
  double outside = 0.0;        ///< square outside the span
  double drawn_outside = 0.0;  ///< square outside the span of what runs differ by

  /// What was run at the explanation's fit, reduced; its covariance is kept by reference.
  void add(const AtFit& run) {
    response += run.beyond;
    draws.emplace_back(&run.error, 1.0);
  }
};

/// Responses of as many explanations as there are lanes, or fewer, a component each.
std::vector<LaneNumbers> responses_of(std::span<const Expected> expected);

/// How explanations, one in each lane, are known: degrees of freedom of their covariances, minus the
/// logarithm of the density at its peak, and by how much errors widen what is outside the span. Lanes beyond
/// the explanations say nothing.
struct Predictions {
  std::size_t size = 0;
  LaneNumbers dof, log_volume, widening, log_widening;
};

/// Room for the covariances of one prediction at a time, which are large, and for a gap.
struct Workspace {
  explicit Workspace(Eigen::Index size)
      : factors(size), missed(static_cast<std::size_t>(size)), solved(missed.size()) {}
  LaneFactors factors;
  std::vector<LaneNumbers> missed, solved;
};

/// How well each of some predictions fits: logarithm of the density, and Mahalanobis distance squared.
struct Fits {
  LaneNumbers log_likelihood, chi_squared;
};

/// Features in units of their noise, believed inputs included, reduced to the directions that responses of
/// all effects span beyond it. What lies outside is kept as one number, its square. Features whose responses
/// are exact are directions of their own, the last ones.
class ReducedSpace {
 public:
  ReducedSpace(const Gap& gap, const std::vector<Signature>& signatures);

  Eigen::VectorXd reduced(const Eigen::VectorXd& v) const { return reducer_ * v; }
  Eigen::MatrixXd reduced_covariance(const Eigen::MatrixXd& covariance) const {
    return reducer_ * covariance * reducer_.transpose();
  }
  Signature reduced(Signature signature) const;
  ReducedGap gap(const Eigen::VectorXd& values) const;
  Eigen::Index size() const { return reducer_.rows(); }
  /// The vector that has these coordinates, the first ones, and nothing in the others and outside the span.
  Eigen::VectorXd spanned(const Eigen::VectorXd& coordinates) const;
  /// Of these directions, those in which responses have errors.
  Eigen::Index inexact() const { return size() - static_cast<Eigen::Index>(exact_.size()); }
  /// The square of what is outside the span.
  double outside(const Eigen::VectorXd& v) const;

  /// Of as many explanations as there are lanes, or fewer. What runs differ by counts so many times in terms
  /// of standard deviations. Leaves the factors of their covariances, noise included, in `room`.
  Predictions predict(std::span<const Expected> expected, double scale, Workspace& room) const;

  /// With the factors that `room` holds of the predictions. The density is the multivariate t of Sellentin &
  /// Heavens (2016, MNRAS 456, L132).
  Fits fit(const ReducedGap& gap, const std::vector<LaneNumbers>& responses, const Predictions& predictions,
           Workspace& room) const;

  /// Parts of the log-likelihood, within the span at a χ² and outside it, where the noise's standard
  /// deviation is so many times as large.
  double log_within(const Predictions& predictions, std::size_t lane, double chi_squared,
                    double factor) const;
  double log_outside(const Predictions& predictions, std::size_t lane, const ReducedGap& gap,
                     double factor) const;

 private:
  Eigen::VectorXd whiten(const Eigen::VectorXd& v) const { return factor_.matrixL().solve(v); }
  void reduce(Response& response) const;
  void find_directions(const std::vector<Signature>& signatures);
  void learn_outside(const std::vector<double>& known);

  Eigen::LLT<Eigen::MatrixXd> factor_;  // of the noise's covariance
  Eigen::MatrixXd precision_;           // its inverse
  double dof_;
  std::vector<Eigen::Index> exact_;  // features
  Eigen::MatrixXd reducer_;          // whitens, and takes what is along orthonormal directions
  double dimensions_ = 0.0;          // outside the span
  double outside_scale_ = 1.0, log_outside_scale_ = 0.0, outside_dof_ = 1.0;
  double log_chi_ = 0.0;  // normalisation of the density outside
};

}  // namespace pendular::diagnosis
