#pragma once

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace pendular::diagnosis {

/// What a change of magnitude θ does to the features, Σ θ^(k+1) powers[k] + ln(1 + |θ|/early_at) early, and
/// by how much runs of it differ from that: draws of an effect differ, and such a sum is not the effect. The
/// logarithm stands for sizes, whose squares grow from what members scatter by.
struct Response {
  std::vector<Eigen::VectorXd> powers;
  Eigen::VectorXd early = {};  ///< empty: none
  double early_at = 1.0;
  Eigen::MatrixXd draws = {};  ///< covariance by which runs of it are missed, at drawn_at; empty: none
  double drawn_at = 1.0;       ///< |θ| of that covariance
  double growth = 2.0;         ///< power of θ with which it grows
  Eigen::MatrixXd missed =
      {};  ///< by how much runs were missed, left out, at drawn_at: a row each that shows all
  Eigen::MatrixXd scatter = {};  ///< covariance of those rows that is the runs' scatter
  double drawn_dof = 0.0;        ///< degrees of freedom of draws; 0: known
  double drawn_outside = 0.0;    ///< trace of draws outside the span of all responses, of a reduced response

  Eigen::VectorXd at(double theta) const {
    Eigen::VectorXd sum = theta * powers.back();  // Horner's scheme
    for (std::size_t k = powers.size() - 1; k > 0; --k) sum = theta * (powers[k - 1] + sum);
    if (early.size() > 0) sum += std::log1p(std::fabs(theta) / early_at) * early;
    return sum;
  }
  /// The covariance of draws at θ over that at drawn_at.
  double grown(double theta) const { return std::pow(std::fabs(theta) / drawn_at, growth); }
};

/// What an effect does, and how large it may be.
struct Signature : Response {
  std::string id;
  std::optional<Response>
      below;  ///< for negative θ, where that is another response: bonds that break do not heal
  double lowest = 0.0, highest = 0.0;  ///< of θ
  double scale = 0.0;                  ///< a usual |θ|
  double least = 0.0;                  ///< |θ| below which the effect counts as absent
  double error = 0.1;                  ///< of each feature's response, as a share of it
  std::vector<Response> others = {};   ///< each may be the response as well, and is as likely
  double outside = 0.03;  ///< of what it does outside the span of all responses, over what it does

  /// How many responses it may have, and each of them; the first is that of at().
  std::size_t readings() const { return 1 + others.size(); }
  const Response& response(double theta, std::size_t reading = 0) const {
    if (reading > 0) return others[reading - 1];
    return theta < 0.0 && below ? *below : *this;
  }
  Eigen::VectorXd at(double theta) const { return response(theta).at(theta); }
};

/// What runs of two effects together show beyond the sum of each, at magnitudes; it grows with their product.
struct Together {
  std::string a, b;
  double theta_a = 0.0, theta_b = 0.0;
  Eigen::VectorXd beyond;
  Eigen::MatrixXd error = {};  ///< covariance of that, from few runs; empty: none

  /// By how much it has grown at magnitudes.
  double grown(double at_a, double at_b) const { return at_a / theta_a * at_b / theta_b; }
  Eigen::VectorXd at(double at_a, double at_b) const { return grown(at_a, at_b) * beyond; }
};

/// What runs at the best fit of an explanation, its believed inputs included, show beyond what responses add
/// up to (at_fit()).
struct AtFit {
  std::string id;          ///< of the explanation
  Eigen::VectorXd beyond;  ///< of the features
  Eigen::MatrixXd error;   ///< covariance of that, from few runs
};

/// A gap to be explained. Features are logarithms of ratios or differences of strains; all in one order.
struct Gap {
  Eigen::VectorXd values;  ///< observed less simulated
  Eigen::MatrixXd
      covariance;    ///< of what is neither effect nor believed input: ensemble, measurement, specimen
  double dof = 0.0;  ///< degrees of freedom of that covariance where it was estimated; 0: known
  /// What runs without an effect leave outside the span of all responses, squared, in units of the noise.
  std::vector<double> outside = {};
  Eigen::MatrixXd believed;  ///< what one standard deviation of each believed input does: a column each
  std::vector<Eigen::Index> exact = {};  ///< features that do what effects say, with independent noise
  std::vector<AtFit> at_fit = {};        ///< of explanations that were run as they fit
};

}  // namespace pendular::diagnosis
