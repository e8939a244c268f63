#include "diagnosis/inference/gap.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "base/random.h"

namespace pendular::diagnosis {
namespace {

constexpr int kDraws = 4000;

/// 95 % quantile of the largest |z| under noise alone.
double threshold_of(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  std::vector<double> largest;
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd noise(sigma.size());
    for (Eigen::Index k = 0; k < noise.size(); ++k)
      noise[k] = random_normal(draw, static_cast<std::uint64_t>(k));
    largest.push_back((factor * noise).cwiseQuotient(sigma).cwiseAbs().maxCoeff());
  }
  return ordered_value(std::move(largest), static_cast<std::size_t>(0.95 * kDraws));
}

}  // namespace

Eigen::MatrixXd whole_covariance(const Gap& gap) {
  return gap.covariance + gap.believed * gap.believed.transpose();
}

GapTable gap_table(const std::vector<Feature>& observed, const std::vector<double>& simulated,
                   const Gap& gap) {
  const Eigen::MatrixXd covariance = whole_covariance(gap);
  const Eigen::MatrixXd inverse =
      covariance.llt().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  const Eigen::VectorXd pull = inverse * gap.values;
  GapTable table;
  table.threshold = threshold_of(covariance);
  std::vector<double> floors;
  double total = 0.0;
  for (std::size_t k = 0; k < observed.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    GapRow row{observed[k], simulated[k], -gap.values[at], std::sqrt(covariance(at, at))};
    row.z = row.difference / row.sigma;
    row.significant = std::fabs(row.z) > table.threshold;
    row.share = pull[at] * pull[at] / inverse(at, at);
    total += row.share;
    if (observed[k].logarithm) floors.push_back(row.sigma);
    table.rows.push_back(row);
  }
  for (auto& row : table.rows) row.share = total > 0.0 ? row.share / total : 0.0;
  table.distance = std::sqrt(gap.values.dot(pull) / static_cast<double>(observed.size()));
  table.excess = excess(gap);
  table.noise_floor = median(floors);
  return table;
}

double excess(const Gap& gap) {
  const double squared = gap.values.dot(whole_covariance(gap).llt().solve(gap.values));
  return std::sqrt(std::max(0.0, squared / static_cast<double>(gap.values.size()) - 1.0));
}

}  // namespace pendular::diagnosis
