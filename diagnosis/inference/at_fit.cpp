#include "diagnosis/inference/at_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/eigensystem.h"

namespace pendular::diagnosis {
namespace {

constexpr double kLeastScatter = 0.1;  // of what runs scatter by, that no draw explains
constexpr double kFirstVariance = 1e-3, kVarianceStep = 1.25;
constexpr int kVariances = 80;  // variances that are tried, beside zero

/// The variance of what is seen, beyond that of its noise, under which it is the likeliest.
double likeliest_variance(const Eigen::ArrayXd& seen, const Eigen::ArrayXd& noise) {
  double best = -std::numeric_limits<double>::infinity(), found = 0.0;
  for (int step = -1; step < kVariances; ++step) {
    const double variance = step < 0 ? 0.0 : kFirstVariance * std::pow(kVarianceStep, step);
    const Eigen::ArrayXd all = variance + noise;
    if (const double likelihood = -(all.log() + seen.square() / all).sum(); likelihood > best)
      best = likelihood, found = variance;
  }
  return found;
}

}  // namespace

AtFit at_fit(const std::string& id, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& drawn,
             const ReducedSpace& space) {
  const Eigen::Index free = space.inexact();
  const auto runs = static_cast<double>(rows.rows());
  Eigen::MatrixXd off(rows.rows(), free);
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    off.row(r) = space.reduced(rows.row(r).transpose()).head(free).transpose();
  const Eigen::RowVectorXd mean = off.colwise().mean();
  const double scatter = (off.rowwise() - mean).squaredNorm() / (runs - 1.0);

  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(free, free);
  if (drawn.size() > 0) noise = drawn.topLeftCorner(free, free);
  noise.diagonal().array() +=
      std::max(scatter - noise.trace(), kLeastScatter * scatter) / static_cast<double>(free);
  const auto [values, ways] = eigensystem(noise / runs);
  const Eigen::ArrayXd variances = values.array().max(std::numeric_limits<double>::min());
  const Eigen::ArrayXd seen = (ways.transpose() * mean.transpose()).array();
  const double own = likeliest_variance(seen, variances);

  const Eigen::VectorXd expected = own / (own + variances) * seen;
  const Eigen::VectorXd left = own / (own + variances) * variances;
  Eigen::MatrixXd back = Eigen::MatrixXd::Zero(rows.cols(), free);
  for (Eigen::Index k = 0; k < free; ++k) back.col(k) = space.spanned(ways.col(k));
  return {id, back * expected, back * left.asDiagonal() * back.transpose()};
}

const AtFit* at_fit_of(const std::vector<AtFit>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const AtFit& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace pendular::diagnosis
