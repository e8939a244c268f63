#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace pendular::pipette {

/// Covariance of the errors of one point (x, y), the same for all.
using Covariance = Eigen::Matrix2d;

struct LineFit {
  double slope = 0.0, intercept = 0.0;
  double slope_sigma = 0.0;  ///< widened where the points scatter more than their errors say
  double reduced_chi2 = 0.0;
  std::size_t points = 0;
};

/// Straight line through points with correlated errors in both coordinates: least Σ (y − a − b x)²/(σ_y² −
/// 2 b σ_xy + b² σ_x²), which for equal errors is an eigenvector of the scatter in the metric of the errors
/// (Deming; slope error after York et al. 2004, Am. J. Phys. 72, 367, Eq. 13). At least three points and a
/// positive definite covariance; none where the points have no extent along x.
std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y,
                                const Covariance& errors);

/// Errors of points taken at equal intervals of a smooth motion, from their second differences, by medians so
/// that turning points do not count (Gnanadesikan & Kettenring 1972, Biometrics 28, 81, for the covariance).
/// `number` counts the frames: only three in a row are compared. None with fewer than eight such triples.
std::optional<Covariance> noise_of(std::span<const double> x, std::span<const double> y,
                                   std::span<const long long> number);

/// Whether the residuals of a line show a parabola or cubic along it at a significance (F test with 2 and n −
/// 4 degrees of freedom).
bool is_curved(std::span<const double> x, std::span<const double> y, const LineFit& line,
               const Covariance& errors, double significance);

/// The line through the longest run of points, from the first on, that is not curved.
struct LinearRange {
  LineFit line;
  std::size_t points = 0;  ///< from the first on
};

/// None where no run of at least `least` points is straight, or its slope is within five sigmas of zero.
std::optional<LinearRange> find_linear_range(std::span<const double> x, std::span<const double> y,
                                             const Covariance& errors, std::size_t least,
                                             double significance = 0.01);

}  // namespace pendular::pipette
