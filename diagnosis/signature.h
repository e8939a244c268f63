#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace pendular::diagnosis {

/// What an effect of magnitude θ does to the features, Σ θ^(k+1) powers[k]; and how large it may be.
struct Signature {
  std::string id;
  std::vector<Eigen::VectorXd> powers;
  double lowest = 0.0, highest = 0.0;  ///< of θ
  double scale = 0.0;                  ///< a usual |θ|
  double least = 0.0;                  ///< |θ| below which the effect counts as absent
  double error = 0.1;                  ///< of each feature's response, as a share of it
  Eigen::MatrixXd draws = {};          ///< covariance of what draws of it differ by, at drawn_at; empty: none
  double drawn_at = 1.0;               ///< θ of that covariance, which grows with θ²

  Eigen::VectorXd at(double theta) const {
    Eigen::VectorXd sum = theta * powers.back();  // Horner's scheme
    for (std::size_t k = powers.size() - 1; k > 0; --k) sum = theta * (powers[k - 1] + sum);
    return sum;
  }
};

/// What runs of two effects together show beyond the sum of each, at magnitudes; it grows with their product.
struct Together {
  std::string a, b;
  double theta_a = 0.0, theta_b = 0.0;
  Eigen::VectorXd beyond;
};

/// A gap to be explained. Features are logarithms of ratios or differences of strains; all in one order.
struct Gap {
  Eigen::VectorXd values;  ///< observed less simulated
  Eigen::MatrixXd
      covariance;        ///< of what is neither effect nor believed input: ensemble, measurement, specimen
  double freedom = 0.0;  ///< degrees of freedom of that covariance where it was estimated; 0: known
  /// What known runs leave outside the span of all responses, squared, in units of the noise: how it scatters.
  std::vector<double> outside = {};
  Eigen::MatrixXd believed;  ///< what one standard deviation of each believed input does: a column each
};

}  // namespace pendular::diagnosis
