#include "pipette/line_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/distributions.h"
#include "base/quantile.h"

namespace pendular::pipette {
namespace {

double error_across(double slope, const Covariance& c) {
  return c(1, 1) - 2.0 * slope * c(0, 1) + slope * slope * c(0, 0);
}

/// The point on the line that a measured point most probably stands for: its x.
double adjusted_x(double x, double residual, double slope, const Covariance& c) {
  return x + residual * (slope * c(0, 0) - c(0, 1)) / error_across(slope, c);
}

/// Standard deviation of second differences' noise per point, from the median of their absolute values.
double robust_sd(std::vector<double> second_differences) {
  for (double& d : second_differences) d = std::abs(d);
  return 1.4826 * median(std::move(second_differences)) /
         std::sqrt(6.0);  // 1 + 4 + 1 variances in a second difference
}

}  // namespace

std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y,
                                const Covariance& errors) {
  const std::size_t n = x.size();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < n; ++k) mean += Eigen::Vector2d(x[k], y[k]) / static_cast<double>(n);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d d = Eigen::Vector2d(x[k], y[k]) - mean;
    scatter += d * d.transpose();
  }
  // Both are of the size of their own units; the line's normal (−b, 1) is the vector of least scatter.
  const Eigen::Vector2d unit = errors.diagonal().cwiseSqrt();
  const Eigen::Matrix2d scale = unit.cwiseInverse().asDiagonal();
  const double correlation = errors(0, 1) / (unit.x() * unit.y());
  const double rest = std::sqrt(1.0 - correlation * correlation);
  if (!(rest > 0.0)) return std::nullopt;
  Eigen::Matrix2d white;  // to coordinates whose errors are independent
  white << 1.0, 0.0, -correlation / rest, 1.0 / rest;
  const Eigen::Matrix2d whitened = white * scale;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(whitened * scatter * whitened.transpose());
  const Eigen::Vector2d normal = whitened.transpose() * solver.eigenvectors().col(0);
  if (!(std::abs(normal.y()) * unit.y() > 1e-12)) return std::nullopt;
  LineFit fit;
  fit.points = n;
  fit.slope = -normal.x() / normal.y();
  fit.intercept = mean.y() - fit.slope * mean.x();
  const double across = error_across(fit.slope, errors);
  double chi2 = 0.0, extent = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double residual = y[k] - fit.intercept - fit.slope * x[k];
    chi2 += residual * residual / across;
    extent += std::pow(adjusted_x(x[k], residual, fit.slope, errors) - mean.x(), 2);
  }
  if (!(extent > 0.0) || !std::isfinite(fit.slope)) return std::nullopt;
  fit.reduced_chi2 = chi2 / static_cast<double>(n - 2);
  fit.slope_sigma = std::sqrt(across / extent * std::max(1.0, fit.reduced_chi2));
  return fit;
}

std::optional<Covariance> noise_of(std::span<const double> x, std::span<const double> y,
                                   std::span<const long long> number) {
  std::vector<double> dx, dy;
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    if (number[k + 1] - number[k] != 1 || number[k] - number[k - 1] != 1) continue;
    dx.push_back(x[k - 1] - 2.0 * x[k] + x[k + 1]);
    dy.push_back(y[k - 1] - 2.0 * y[k] + y[k + 1]);
  }
  if (dx.size() < 8) return std::nullopt;
  const double sx = robust_sd(dx), sy = robust_sd(dy);
  if (!(sx > 0.0) || !(sy > 0.0)) return std::nullopt;
  std::vector<double> sum(dx.size()), difference(dx.size());
  for (std::size_t k = 0; k < dx.size(); ++k) {
    sum[k] = dx[k] / sx + dy[k] / sy;
    difference[k] = dx[k] / sx - dy[k] / sy;
  }
  const double s = std::pow(robust_sd(sum), 2), d = std::pow(robust_sd(difference), 2);
  const double correlation = std::clamp(s + d > 0.0 ? (s - d) / (s + d) : 0.0, -0.95, 0.95);
  Covariance c;
  c << sx * sx, correlation * sx * sy, correlation * sx * sy, sy * sy;
  return c;
}

bool is_curved(std::span<const double> x, std::span<const double> y, const LineFit& line,
               const Covariance& errors, double significance) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::VectorXd u(n), residual(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    residual(k) = y[i] - line.intercept - line.slope * x[i];
    u(k) = adjusted_x(x[i], residual(k), line.slope, errors);
  }
  const double middle = 0.5 * (u.maxCoeff() + u.minCoeff()), half = 0.5 * (u.maxCoeff() - u.minCoeff());
  if (!(half > 0.0)) return true;
  const Eigen::ArrayXd t = (u.array() - middle) / half;
  Eigen::MatrixXd basis(n, 4);
  basis << Eigen::VectorXd::Ones(n), t, t.square(), t.cube();
  const auto squares = [&](Eigen::Index columns) {
    const Eigen::MatrixXd b = basis.leftCols(columns);
    const Eigen::VectorXd fitted = b * (b.transpose() * b).ldlt().solve(b.transpose() * residual);
    return (residual - fitted).squaredNorm();
  };
  const double straight = squares(2), bent = squares(4), dof = static_cast<double>(n - 4);
  return 0.5 * (straight - bent) > f_quantile(1.0 - significance, 2.0, dof) * bent / dof;
}

std::optional<LinearRange> find_linear_range(std::span<const double> x, std::span<const double> y,
                                             const Covariance& errors, std::size_t least,
                                             double significance) {
  for (std::size_t n = x.size(); n >= std::max<std::size_t>(least, 8); --n) {
    const auto line = fit_line(x.first(n), y.first(n), errors);
    if (!line || is_curved(x.first(n), y.first(n), *line, errors, significance)) continue;
    if (std::abs(line->slope) < 5.0 * line->slope_sigma) return std::nullopt;
    return LinearRange{*line, n};
  }
  return std::nullopt;
}

}  // namespace pendular::pipette
