#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "volume/volume.h"

namespace pendular::test {

struct TrueBall {
  Vec3 centre;    ///< voxels
  double radius;  ///< voxels
};

/// Grey value `outside` + `edge` × Σ blurred balls + noise, 16 bit: the edge profile is that of a
/// half-space, ½ erfc((r − R)/(√2 s)), with its curvature term −(s/r) φ.
inline Volume ball_volume(const std::array<std::size_t, 3>& size, const std::vector<TrueBall>& balls,
                          double blur, double noise, double outside = 10000.0, double edge = 20000.0) {
  std::vector<double> share(size[0] * size[1] * size[2], 0.0);
  for (const TrueBall& ball : balls) {
    std::array<long, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(0L, static_cast<long>(ball.centre[axis] - ball.radius - 6.0 * blur));
      high[axis] = std::min(static_cast<long>(size[axis]) - 1,
                            static_cast<long>(ball.centre[axis] + ball.radius + 6.0 * blur) + 1);
    }
    for (long k = low[2]; k <= high[2]; ++k)
      for (long j = low[1]; j <= high[1]; ++j)
        for (long i = low[0]; i <= high[0]; ++i) {
          const double r = std::max(1e-3, (Vec3(double(i), double(j), double(k)) - ball.centre).norm());
          const double t = (ball.radius - r) / blur;
          share[(static_cast<std::size_t>(k) * size[1] + static_cast<std::size_t>(j)) * size[0] +
                static_cast<std::size_t>(i)] += 0.5 * std::erfc(-t / std::sqrt(2.0)) -
                                                blur / r * std::exp(-0.5 * t * t) / std::sqrt(2.0 * M_PI);
        }
  }
  std::vector<std::uint16_t> pixels(share.size());
  for_blocks(share.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      pixels[n] = static_cast<std::uint16_t>(
          std::lround(std::clamp(outside + edge * (share[n] + noise * random_normal(1, n)), 0.0, 65535.0)));
  });
  return {size, 1e-6, Vec3::Zero(), pixels};
}

}  // namespace pendular::test
