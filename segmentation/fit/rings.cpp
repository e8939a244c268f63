#include "segmentation/fit/rings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

constexpr double kStepsPerVoxel = 4.0;

/// Of the picture: where the axis of rotation is.
std::pair<double, double> middle_of(const Volume& volume) {
  return {0.5 * (static_cast<double>(volume.size[0]) - 1.0),
          0.5 * (static_cast<double>(volume.size[1]) - 1.0)};
}

/// Sums over the voxels of either half of the balls.
struct Sums {
  std::array<double, 2> residual{}, voxels{};

  double all_voxels() const { return voxels[0] + voxels[1]; }
  double mean() const { return (residual[0] + residual[1]) / all_voxels(); }
};

/// Calls f(i, j) for the voxels of slice k in the ball's core.
template <typename Function>
void for_core(const Volume& volume, const GreyBall& ball, double margin, std::size_t k, const Function& f) {
  const double core = ball.radius - margin, z = static_cast<double>(k) - ball.centre.z();
  if (core <= std::fabs(z)) return;
  const double disc = std::sqrt(core * core - z * z);
  const auto range = [&](double middle, double half, std::size_t size) {
    return std::pair(static_cast<std::size_t>(std::max(0.0, std::ceil(middle - half))),
                     static_cast<std::size_t>(
                         std::clamp(std::floor(middle + half) + 1.0, 0.0, static_cast<double>(size))));
  };
  const auto [low, high] = range(ball.centre.y(), disc, volume.size[1]);
  for (std::size_t j = low; j < high; ++j) {
    const double y = static_cast<double>(j) - ball.centre.y();
    const auto [first, last] =
        range(ball.centre.x(), std::sqrt(std::max(0.0, disc * disc - y * y)), volume.size[0]);
    for (std::size_t i = first; i < last; ++i) f(i, j);
  }
}

/// Calls f(i, j, rest) for the voxels of slice k in the ball's core, `rest` being the grey value without the
/// slope of the ball's levels.
template <typename T, typename Function>
void for_core(std::span<const T> pixels, const Volume& volume, const GreyBall& ball, double margin,
              std::size_t k, const Function& f) {
  const Vec3 slope = ball.contrast_slope + ball.background_slope;
  for_core(volume, ball, margin, k, [&](std::size_t i, std::size_t j) {
    const Vec3 p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    const auto grey = static_cast<double>(pixels[(k * volume.size[1] + j) * volume.size[0] + i]);
    f(i, j, grey - slope.dot(p - ball.centre));
  });
}

/// The slices that a ball is in.
std::pair<std::size_t, std::size_t> slices_of(const Volume& volume, const GreyBall& ball) {
  const auto slice = [&](double z) {
    return static_cast<std::size_t>(std::clamp(z, 0.0, static_cast<double>(volume.size[2])));
  };
  return {slice(std::ceil(ball.centre.z() - ball.radius)),
          slice(std::floor(ball.centre.z() + ball.radius) + 1.0)};
}

/// Of a ball's core, sums of grey values and numbers of voxels by distance.
struct Core {
  std::size_t first = 0;  ///< of the distances
  std::vector<double> grey, voxels;
  double mean = 0.0;  ///< of the grey values, without the rings
};

template <typename T>
Core core_of(std::span<const T> pixels, const Volume& volume, const GreyBall& ball, double margin,
             const Rings& rings) {
  const auto [x, y] = middle_of(volume);
  const double away = std::hypot(ball.centre.x() - x, ball.centre.y() - y);
  Core core;
  core.first = static_cast<std::size_t>(kStepsPerVoxel * std::max(0.0, away - ball.radius));
  const auto end = static_cast<std::size_t>(kStepsPerVoxel * (away + ball.radius)) + 1;
  core.grey.resize(std::min(end, rings.steps) - core.first);
  core.voxels.resize(core.grey.size());
  const auto [first, last] = slices_of(volume, ball);
  for (std::size_t k = first; k < last; ++k)
    for_core(pixels, volume, ball, margin, k, [&](std::size_t i, std::size_t j, double grey) {
      const std::size_t step = rings.step[j * rings.width + i] - core.first;
      core.grey[step] += grey, core.voxels[step] += 1.0;
    });
  return core;
}

/// What is left of all cores beside their means, by distance.
std::vector<Sums> left_of(const std::vector<Core>& cores, std::size_t steps) {
  std::vector<Sums> left(steps);
  for (std::size_t n = 0; n < cores.size(); ++n)
    for (std::size_t m = 0; m < cores[n].grey.size(); ++m) {
      Sums& own = left[cores[n].first + m];
      own.residual[n % 2] += cores[n].grey[m] - cores[n].voxels[m] * cores[n].mean;
      own.voxels[n % 2] += cores[n].voxels[m];
    }
  return left;
}

/// Means of the cores and a value of each distance that together are nearest to the grey values, by least
/// squares in turn: rings nearly as wide as a bead are in its mean, too.
void part_means_from_rings(std::vector<Core>& cores, std::size_t steps) {
  constexpr int turns = 100;
  std::vector<double> rings(steps, 0.0);
  for (int turn = 0; turn < turns; ++turn) {
    for (Core& core : cores) {
      double sum = 0.0, count = 0.0;
      for (std::size_t m = 0; m < core.grey.size(); ++m)
        sum += core.grey[m] - core.voxels[m] * rings[core.first + m], count += core.voxels[m];
      core.mean = count > 0.0 ? sum / count : 0.0;
    }
    const auto left = left_of(cores, steps);
    for (std::size_t m = 0; m < steps; ++m) rings[m] = left[m].all_voxels() > 0.0 ? left[m].mean() : 0.0;
  }
}

/// What is left in the cores beside their means, by slice and distance.
template <typename T>
std::vector<Sums> left_by_slice(std::span<const T> pixels, const Volume& volume,
                                std::span<const GreyBall> balls, double margin,
                                const std::vector<Core>& cores, const Rings& rings) {
  std::vector<std::vector<std::size_t>> in_slice(volume.size[2]);
  for (std::size_t n = 0; n < balls.size(); ++n) {
    const auto [first, last] = slices_of(volume, balls[n]);
    for (std::size_t k = first; k < last; ++k) in_slice[k].push_back(n);
  }
  std::vector<Sums> left(volume.size[2] * rings.steps);
  for_blocks(volume.size[2], 1, [&](std::size_t k, std::size_t) {
    for (const std::size_t n : in_slice[k])
      for_core(pixels, volume, balls[n], margin, k, [&](std::size_t i, std::size_t j, double grey) {
        Sums& own = left[k * rings.steps + rings.step[j * rings.width + i]];
        own.residual[n % 2] += grey - cores[n].mean;
        own.voxels[n % 2] += 1.0;
      });
  });
  return left;
}

/// What of the sums' means is no noise.
struct Signal {
  double variance = 0.0;  ///< of it
  double noise = 0.0;     ///< variance of a voxel's
  bool shown = false;

  /// The likeliest value where this mean was found.
  double likeliest(const Sums& sums) const {
    const double voxels = sums.all_voxels();
    return shown && voxels > 0.0 ? sums.mean() * variance / (variance + noise / voxels) : 0.0;
  }
};

/// Both halves of the balls see the same rings, but not the same noise.
Signal signal_of(std::span<const Sums> all) {
  constexpr double least_voxels = 4.0;
  double product = 0.0, weights = 0.0, differences = 0.0, chance = 0.0, count = 0.0;
  for (const Sums& sums : all) {
    const double m = sums.voxels[0], n = sums.voxels[1];
    if (m < least_voxels || n < least_voxels) continue;
    const double a = sums.residual[0] / m, b = sums.residual[1] / n, weight = m * n / (m + n);
    product += weight * a * b, weights += weight;
    differences += weight * (a - b) * (a - b), count += 1.0;
    chance += weight * weight / (m * n);
  }
  if (count == 0.0) return {};
  const double noise = differences / count;
  return {product / weights, noise, product > kThresholds.ring_sigmas * noise * std::sqrt(chance)};
}

Rings no_rings(const Volume& volume) {
  Rings rings;
  rings.width = volume.size[0];
  const auto [x, y] = middle_of(volume);
  rings.steps = static_cast<std::size_t>(kStepsPerVoxel * std::hypot(x, y)) + 1;
  for (std::size_t j = 0; j < volume.size[1]; ++j)
    for (std::size_t i = 0; i < volume.size[0]; ++i)
      rings.step.push_back(static_cast<std::uint32_t>(
          kStepsPerVoxel * std::hypot(static_cast<double>(i) - x, static_cast<double>(j) - y)));
  rings.grey.assign(rings.steps * volume.size[2], 0.0F);
  return rings;
}

}  // namespace

std::shared_ptr<const Rings> find_rings(const Volume& volume, std::span<const GreyBall> balls,
                                        double margin) {
  // Whether there are any, some of the balls tell, in a fraction of the time.
  constexpr std::size_t enough = 1000;
  if (balls.size() >= 2 * enough) {
    std::vector<GreyBall> some;
    for (std::size_t n = 0; n < balls.size(); n += balls.size() / enough) some.push_back(balls[n]);
    if (!find_rings(volume, some, margin)) return nullptr;
  }
  Rings rings = no_rings(volume);
  std::vector<Core> cores(balls.size());
  with_pixels(volume, [&](auto pixels) {
    for_blocks(balls.size(), 1, [&](std::size_t n, std::size_t) {
      cores[n] = core_of(pixels, volume, balls[n], margin, rings);
    });
  });
  part_means_from_rings(cores, rings.steps);
  const auto shared = left_of(cores, rings.steps);
  const Signal in_all = signal_of(shared);
  auto sums = with_pixels(
      volume, [&](auto pixels) { return left_by_slice(pixels, volume, balls, margin, cores, rings); });
  for (std::size_t n = 0; n < sums.size(); ++n) {
    const double value = in_all.likeliest(shared[n % rings.steps]);
    rings.grey[n] = static_cast<float>(value);
    for (std::size_t half = 0; half < 2; ++half) sums[n].residual[half] -= value * sums[n].voxels[half];
  }
  const Signal in_each = signal_of(sums);
  if (!in_all.shown && !in_each.shown) return nullptr;
  constexpr double least_voxels = 20.0;
  double squares = 0.0, voxels = 0.0;
  for (std::size_t n = 0; n < sums.size(); ++n) {
    float& grey = rings.grey[n];
    grey += static_cast<float>(in_each.likeliest(sums[n]));
    squares += sums[n].all_voxels() * std::pow(static_cast<double>(grey), 2);
    voxels += sums[n].all_voxels();
    if (shared[n % rings.steps].all_voxels() < least_voxels) grey = std::numeric_limits<float>::quiet_NaN();
  }
  rings.rms = std::sqrt(squares / voxels);
  if (rings.rms < kThresholds.ring_over_noise * std::sqrt(in_each.noise)) return nullptr;
  return std::make_shared<const Rings>(std::move(rings));
}

}  // namespace pendular::segmentation
