#include "segmentation/fit/noise.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/quantile.h"
#include "segmentation/fit/ball_profile.h"
#include "segmentation/fit/rings.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

constexpr std::size_t most_balls = 200;
constexpr int most_lag = 8;

struct LagSums {
  double product[most_lag + 1] = {}, pairs[most_lag + 1] = {};
};

/// Products of deviations from the core's mean, along the three axes.
template <typename T>
LagSums core_sums(std::span<const T> pixels, const Volume& volume, const GreyBall& ball, double margin,
                  const Rings* rings) {
  LagSums sums;
  const double core = ball.radius - margin;
  if (core < 1.5) return sums;
  const long reach = static_cast<long>(core);
  const long width = 2 * reach + 1;
  std::vector<double> box(static_cast<std::size_t>(width * width * width), std::nan(""));
  const auto at = [&](long i, long j, long k) -> double& {
    return box[static_cast<std::size_t>(((k + reach) * width + j + reach) * width + i + reach)];
  };
  double n = 0.0, sum = 0.0;
  const std::array<long, 3> middle{std::lround(ball.centre.x()), std::lround(ball.centre.y()),
                                   std::lround(ball.centre.z())};
  for (long k = -reach; k <= reach; ++k)
    for (long j = -reach; j <= reach; ++j)
      for (long i = -reach; i <= reach; ++i) {
        const long x = middle[0] + i, y = middle[1] + j, z = middle[2] + k;
        if (static_cast<double>(i * i + j * j + k * k) > core * core) continue;
        if (x < 0 || y < 0 || z < 0 || x >= static_cast<long>(volume.size[0]) ||
            y >= static_cast<long>(volume.size[1]) || z >= static_cast<long>(volume.size[2]))
          continue;
        const double grey = grey_at(pixels, volume, rings, x, y, z);
        if (std::isnan(grey)) continue;
        at(i, j, k) = grey;
        n += 1.0;
        sum += grey;
      }
  if (n < 10.0) return sums;
  for (double& grey : box) grey -= sum / n;
  for (int lag = 0; lag <= std::min<long>(most_lag, reach); ++lag)
    for (long k = -reach; k <= reach; ++k)
      for (long j = -reach; j <= reach; ++j)
        for (long i = -reach; i <= reach; ++i) {
          const double own = at(i, j, k);
          if (std::isnan(own)) continue;
          for (int axis = 0; axis < (lag ? 3 : 1); ++axis) {
            const long a = i + (axis == 0) * lag, b = j + (axis == 1) * lag, c = k + (axis == 2) * lag;
            if (a > reach || b > reach || c > reach || std::isnan(at(a, b, c))) continue;
            sums.product[lag] += own * at(a, b, c);
            sums.pairs[lag] += 1.0;
          }
        }
  // Taking the core's own mean away costs one degree of freedom.
  sums.pairs[0] -= 1.0;
  return sums;
}

/// ρ at a distance between lags, linearly; 0 from the first lag on that is lost in the scatter.
double correlation_at(const std::vector<double>& correlation, double distance) {
  const auto lag = static_cast<std::size_t>(distance);
  if (lag + 1 >= correlation.size()) return lag == 0 && distance == 0.0 ? 1.0 : 0.0;
  const double share = distance - static_cast<double>(lag);
  return (1.0 - share) * correlation[lag] + share * correlation[lag + 1];
}

}  // namespace

Noise measure_noise(const Volume& volume, std::span<const GreyBall> balls, double margin,
                    const Rings* rings) {
  const std::size_t step = std::max<std::size_t>(1, balls.size() / most_balls);
  const std::size_t used = balls.empty() ? 0 : (balls.size() - 1) / step + 1;
  std::vector<LagSums> sums(used);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(used, 1, [&](std::size_t n, std::size_t) {
      sums[n] = core_sums(pixels, volume, balls[n * step], margin, rings);
    });
  });
  // Pores and cracks are not noise: cores that vary by much more than the middle one do not count.
  std::vector<double> variances;
  for (const LagSums& own : sums)
    if (own.pairs[0] > 0.0) variances.push_back(own.product[0] / own.pairs[0]);
  const double most = kThresholds.uneven_core * median(variances);
  LagSums total;
  for (const LagSums& own : sums)
    for (int lag = 0; lag <= most_lag && own.product[0] <= most * own.pairs[0]; ++lag) {
      total.product[lag] += own.product[lag];
      total.pairs[lag] += own.pairs[lag];
    }
  Noise noise{0.0, {1.0}};
  if (total.pairs[0] < 1.0) return noise;
  const double variance = total.product[0] / total.pairs[0];
  noise.sd = std::sqrt(variance);
  constexpr double lost = 0.02;
  for (int lag = 1; lag <= most_lag && total.pairs[lag] > 0.0 && variance > 0.0; ++lag) {
    const double rho = total.product[lag] / total.pairs[lag] / variance;
    noise.correlation.push_back(rho > lost ? rho : 0.0);
    if (rho <= lost) break;
  }
  return noise;
}

double correlated_volume(const Noise& noise) {
  const long lags = static_cast<long>(noise.correlation.size()) - 1;
  double sum = 0.0;
  for (long k = -lags; k <= lags; ++k)
    for (long j = -lags; j <= lags; ++j)
      for (long i = -lags; i <= lags; ++i)
        sum += correlation_at(noise.correlation, std::sqrt(static_cast<double>(i * i + j * j + k * k)));
  return std::max(1.0, sum);
}

VarianceInflation variance_inflation(const Noise& noise, double radius, double blur) {
  const long lags = static_cast<long>(noise.correlation.size()) - 1;
  if (lags < 1) return {};
  const long reach = static_cast<long>(std::ceil(radius + 3.0 * blur)), width = 2 * reach + 1;
  std::vector<double> by_radius(static_cast<std::size_t>(width * width * width), 0.0), by_x = by_radius;
  const auto index = [&](long i, long j, long k) {
    return static_cast<std::size_t>(((k + reach) * width + j + reach) * width + i + reach);
  };
  for (long k = -reach; k <= reach; ++k)
    for (long j = -reach; j <= reach; ++j)
      for (long i = -reach; i <= reach; ++i) {
        const double r = std::sqrt(static_cast<double>(i * i + j * j + k * k));
        if (std::abs(r - radius) > 3.0 * blur || r < 0.5) continue;
        const BallProfile profile = ball_profile(r, radius, blur);
        by_radius[index(i, j, k)] = profile.by_radius;
        by_x[index(i, j, k)] = profile.by_distance * static_cast<double>(i) / r;
      }
  // One octant's share of the rows is enough: the sums over all of them are alike by symmetry.
  double radius_sum = 0.0, radius_white = 0.0, x_sum = 0.0, x_white = 0.0;
  for (long k = 0; k <= reach; ++k)
    for (long j = 0; j <= reach; ++j)
      for (long i = 0; i <= reach; ++i) {
        const double jr = by_radius[index(i, j, k)], jx = by_x[index(i, j, k)];
        if (jr == 0.0) continue;
        for (long c = std::max(-reach, k - lags); c <= std::min(reach, k + lags); ++c)
          for (long b = std::max(-reach, j - lags); b <= std::min(reach, j + lags); ++b)
            for (long a = std::max(-reach, i - lags); a <= std::min(reach, i + lags); ++a) {
              const double distance =
                  std::sqrt(static_cast<double>((a - i) * (a - i) + (b - j) * (b - j) + (c - k) * (c - k)));
              const double rho = correlation_at(noise.correlation, distance);
              radius_sum += jr * by_radius[index(a, b, c)] * rho;
              x_sum += jx * by_x[index(a, b, c)] * rho;
            }
        radius_white += jr * jr;
        x_white += jx * jx;
      }
  return {std::max(1.0, x_sum / x_white), std::max(1.0, radius_sum / radius_white)};
}

}  // namespace pendular::segmentation
