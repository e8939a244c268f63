#include "diagnosis/inference/stated_laws.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

struct Density {
  double squares, half_log_determinant;
};

Density density_of(const Eigen::VectorXd& left, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd& lower = factor.matrixLLT();
  return {left.dot(factor.solve(left)), lower.diagonal().array().log().sum()};
}

/// By how much more probable, as a logarithm, what is left is by the one than by the other.
double log_ratio(const Density& one, const Density& other, Eigen::Index size) {
  const double unit = std::max(1.0, std::min(one.squares, other.squares) / static_cast<double>(size));
  return 0.5 * (other.squares - one.squares) / unit + other.half_log_determinant - one.half_log_determinant;
}

}  // namespace

std::set<std::string> laws_as_stated(const Comparison& readings, const std::vector<Hypothesis>& known) {
  const Eigen::MatrixXd whole = whole_covariance(readings.gap);
  std::vector<Eigen::VectorXd> left;  // by what is probable
  for (const auto& h : known) {
    if (h.probability < kThresholds.least_in_set) continue;
    Magnitudes magnitudes;
    const auto ids = effects_in(h.id);
    for (std::size_t k = 0; k < ids.size(); ++k) magnitudes[ids[k]] = h.magnitudes[k];
    left.push_back(left_by(readings, magnitudes));
  }
  std::set<std::string> found;
  for (const auto& law : readings.laws) {
    Eigen::MatrixXd scatter = law.scatter;
    scatter.diagonal() *= 1.0 + kThresholds.uncorrelated;
    const double settled = std::pow(kThresholds.law_reading, 2) - std::pow(kThresholds.law_as_stated, 2);
    const Eigen::MatrixXd stated = whole - settled * (scatter + law.mean * law.mean.transpose());
    const Eigen::MatrixXd other = stated + scatter;
    if (!left.empty() && std::all_of(left.begin(), left.end(), [&](const Eigen::VectorXd& one) {
          return log_ratio(density_of(one, stated), density_of(one - law.mean, other), one.size()) >
                 std::log(kThresholds.decisive);
        }))
      found.insert(law.id);
  }
  return found;
}

}  // namespace pendular::diagnosis
