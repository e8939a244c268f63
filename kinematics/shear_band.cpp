#include "kinematics/shear_band.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/quantile.h"

namespace pendular::kinematics {
namespace {

constexpr int kDirections = 600;
constexpr int kBinsPerDiameter = 2;
constexpr int kSlabBins = 3 * kBinsPerDiameter;

/// Directions spread evenly over the upper half sphere (Fibonacci spiral).
Vec3 direction(int k) {
  const double z = (k + 0.5) / kDirections, radius = std::sqrt(1.0 - z * z);
  const double turn = M_PI * (3.0 - std::sqrt(5.0)) * k;
  return {radius * std::cos(turn), radius * std::sin(turn), z};
}

/// Strains of the few beads that come loose at the surface are many times those of any band.
std::vector<double> clipped(std::vector<double> values) {
  if (values.empty()) return values;
  const double top = lower_quantile(values, 0.95);
  for (double& value : values) value = std::min(value, top);
  return values;
}

/// Sums of shear strain over slabs across a direction.
struct Profile {
  double first = 0.0, bin_width = 0.0;
  std::vector<double> count, sum;
};

Profile profile(const std::vector<Vec3>& positions, const std::vector<double>& shear, const Vec3& normal,
                double bin_width) {
  double lowest = positions[0].dot(normal), highest = lowest;
  for (const auto& position : positions) {
    lowest = std::min(lowest, position.dot(normal));
    highest = std::max(highest, position.dot(normal));
  }
  Profile result{lowest, bin_width, {}, {}};
  result.count.assign(static_cast<std::size_t>((highest - lowest) / bin_width) + 1, 0.0);
  result.sum = result.count;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto bin = static_cast<std::size_t>((positions[k].dot(normal) - lowest) / bin_width);
    result.count[bin] += 1.0;
    result.sum[bin] += shear[k];
  }
  return result;
}

struct Slab {
  double score = 0.0, offset = 0.0, inside = 0.0, outside = 0.0;
};

Slab best_slab(const Profile& p, double mean, double deviation, double all) {
  Slab best;
  for (std::size_t first = 0; first + kSlabBins <= p.count.size(); ++first) {
    const double count = std::accumulate(p.count.begin() + first, p.count.begin() + first + kSlabBins, 0.0);
    const double sum = std::accumulate(p.sum.begin() + first, p.sum.begin() + first + kSlabBins, 0.0);
    if (count < 0.02 * all || count > 0.6 * all) continue;
    const double score = (sum / count - mean) / deviation * std::sqrt(count);
    if (score > best.score)
      best = {score, p.first + (first + 0.5 * kSlabBins) * p.bin_width, sum / count,
              (mean * all - sum) / (all - count)};
  }
  return best;
}

double full_width_at_half_height(const Profile& p, double offset, double background) {
  const auto mean_at = [&](std::ptrdiff_t bin) {
    return bin < 0 || bin >= static_cast<std::ptrdiff_t>(p.count.size()) || p.count[bin] == 0.0
               ? background
               : p.sum[bin] / p.count[bin];
  };
  auto top = static_cast<std::ptrdiff_t>((offset - p.first) / p.bin_width);
  for (auto bin = top - kSlabBins / 2; bin <= top + kSlabBins / 2; ++bin)
    if (mean_at(bin) > mean_at(top)) top = bin;
  const double half = 0.5 * (mean_at(top) + background);
  auto left = top, right = top;
  while (mean_at(left) > half) --left;
  while (mean_at(right) > half) ++right;
  return static_cast<double>(right - left - 1) * p.bin_width;
}

}  // namespace

ShearBand find_shear_band(const std::vector<Vec3>& positions, const std::vector<double>& all_shear,
                          double mean_diameter) {
  ShearBand band;
  const std::vector<double> shear = clipped(all_shear);
  const double all = static_cast<double>(positions.size());
  const double mean = std::accumulate(shear.begin(), shear.end(), 0.0) / all;
  double variance = 0.0;
  for (double value : shear) variance += (value - mean) * (value - mean) / all;
  if (variance <= 0.0) return band;
  const double bin_width = mean_diameter / kBinsPerDiameter;
  Slab best;
  for (int k = 0; k < kDirections; ++k) {
    const Slab slab =
        best_slab(profile(positions, shear, direction(k), bin_width), mean, std::sqrt(variance), all);
    if (slab.score > best.score) best = slab, band.normal = direction(k);
  }
  if (best.score == 0.0) return band;
  const Vec3 centroid = std::accumulate(positions.begin(), positions.end(), Vec3(Vec3::Zero())) / all;
  band.point = centroid + (best.offset - centroid.dot(band.normal)) * band.normal;
  band.contrast = best.inside / best.outside;
  band.thickness =
      full_width_at_half_height(profile(positions, shear, band.normal, bin_width), best.offset, best.outside);
  band.angle_to_axis = std::asin(std::min(1.0, std::fabs(band.normal.z())));
  band.found = band.contrast >= 1.3;
  return band;
}

}  // namespace pendular::kinematics
