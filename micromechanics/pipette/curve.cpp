#include "pipette/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/distributions.h"
#include "base/error.h"

namespace pendular::pipette {
namespace {

constexpr std::size_t kLeastFrames = 16;
constexpr double kNoiseFloor = 1e-3;  // pixels: no tracker is better, so the errors never vanish

struct Points {
  std::vector<double> extension, force;
  std::vector<long long> number;

  void add(const Curve& curve, std::size_t k) {
    extension.push_back(curve.extension[k]);
    force.push_back(curve.force[k]);
    number.push_back(curve.number[k]);
  }
};

std::optional<Branch> fit_branch(const Points& points, const Covariance& errors) {
  const auto range = find_linear_range(points.extension, points.force, errors, 8);
  if (!range) return std::nullopt;
  const auto extent = [&](std::size_t n) {
    const auto [low, high] =
        std::minmax_element(points.force.begin(), points.force.begin() + static_cast<std::ptrdiff_t>(n));
    return *high - *low;
  };
  if (extent(range->points) < kLeastRange * extent(points.force.size())) return std::nullopt;
  Branch branch;
  branch.line = range->line;
  branch.frames = points.force.size();
  const auto [low, high] = std::minmax_element(
      points.extension.begin(), points.extension.begin() + static_cast<std::ptrdiff_t>(range->points));
  branch.first_extension = *low;
  branch.last_extension = *high;
  return branch;
}

Stiffness with_uncertainty(const LineFit& line, const Calibration& c) {
  Stiffness k;
  k.value = line.slope;
  k.fit_sigma = line.slope_sigma;
  k.calibration_sigma = std::abs(line.slope) * c.pipette_stiffness_sigma / c.pipette_stiffness;
  const double total = std::hypot(k.fit_sigma, k.calibration_sigma);
  const double fit_share = std::pow(k.fit_sigma / total, 4) / static_cast<double>(line.points - 2);
  const double calibration_share =
      std::pow(k.calibration_sigma / total, 4) * 2.0 * c.sigma_reliability * c.sigma_reliability;
  const double half = total * student_quantile(0.95, 1.0 / (fit_share + calibration_share));
  k.low = k.value - half;
  k.high = k.value + half;
  return k;
}

}  // namespace

CurveFit fit_curve(const Curve& curve, const Calibration& calibration, const std::string& name) {
  CurveFit fit;
  Points all, loading, unloading;
  double furthest = -1.0;
  for (std::size_t k = 0; k < curve.used.size(); ++k) {
    if (!curve.used[k]) continue;
    all.add(curve, k);
    if (std::abs(curve.stage[k]) <= furthest) continue;
    furthest = std::abs(curve.stage[k]);
    fit.turn = k;
  }
  if (all.number.size() < kLeastFrames)
    bad_input("{}: found {} frames that can be used, expected at least {}", name, all.number.size(),
              kLeastFrames);
  for (std::size_t k = 0; k < curve.used.size(); ++k)
    if (curve.used[k]) (k <= fit.turn ? loading : unloading).add(curve, k);
  std::reverse(unloading.extension.begin(), unloading.extension.end());
  std::reverse(unloading.force.begin(), unloading.force.end());

  const double floor = kNoiseFloor * calibration.metres_per_pixel;
  const auto noise = noise_of(all.extension, all.force, all.number);
  if (noise) fit.errors = *noise;
  fit.errors(0, 0) += floor * floor;
  fit.errors(1, 1) += std::pow(calibration.pipette_stiffness * floor, 2);
  fit.loading = fit_branch(loading, fit.errors);
  fit.unloading = fit_branch(unloading, fit.errors);
  if (fit.loading) fit.stiffness = with_uncertainty(fit.loading->line, calibration);
  return fit;
}

}  // namespace pendular::pipette
