#include "volume/resample.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/parallel.h"

namespace pendular {
namespace {

/// Four voxels around a place, and their weights.
struct Tap {
  std::array<std::size_t, 4> at;
  std::array<double, 4> weight;
};

std::vector<Tap> taps_of(std::size_t size, double edge) {
  const auto last = static_cast<double>(size - 1);
  std::vector<Tap> taps(static_cast<std::size_t>(std::floor(last * edge + 1e-9)) + 1);
  for (std::size_t n = 0; n < taps.size(); ++n) {
    const double place = std::min(last, static_cast<double>(n) / edge), t = place - std::floor(place);
    for (int k = 0; k < 4; ++k)
      taps[n].at[static_cast<std::size_t>(k)] =
          static_cast<std::size_t>(std::clamp(std::floor(place) + k - 1.0, 0.0, last));
    taps[n].weight = {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                      0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
  }
  return taps;
}

template <typename T>
T grey_of(double value) {
  if constexpr (std::is_floating_point_v<T>) return static_cast<T>(value);
  constexpr double least = std::numeric_limits<T>::min(), greatest = std::numeric_limits<T>::max();
  return static_cast<T>(std::clamp(std::round(value), least, greatest));
}

/// Not a template: in those that a generic lambda instantiates clang 16 leaves out TBB's tasks.
void for_slices(std::size_t slices, const std::function<void(std::size_t)>& work) {
  for_blocks(slices, 1, [&](std::size_t slice, std::size_t) { work(slice); });
}

template <typename T>
std::vector<T> along(std::span<const Grey<T>> pixels, std::array<std::size_t, 3>& size, std::size_t axis,
                     double edge) {
  const auto taps = taps_of(size[axis], edge);
  const std::array<std::size_t, 3> stride{1, size[0], size[0] * size[1]};
  size[axis] = taps.size();
  std::vector<T> result(size[0] * size[1] * size[2]);
  for_slices(size[2], [&](std::size_t k) {
    std::size_t out = k * size[0] * size[1];
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i) {
        const std::array<std::size_t, 3> voxel{i, j, k};
        std::size_t base = 0;
        for (std::size_t other = 0; other < 3; ++other)
          if (other != axis) base += voxel[other] * stride[other];
        const Tap& tap = taps[voxel[axis]];
        double sum = 0.0;
        for (std::size_t n = 0; n < 4; ++n)
          sum += tap.weight[n] * static_cast<double>(pixels[base + tap.at[n] * stride[axis]]);
        result[out++] = grey_of<T>(sum);
      }
  });
  return result;
}

}  // namespace

Volume resampled(const Volume& volume, const std::array<double, 3>& edges) {
  Volume result = volume;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (edges[axis] == 1.0) continue;
    result.pixels = with_pixels(result, [&]<typename T>(std::span<const Grey<T>> pixels) -> Volume::Pixels {
      return along(pixels, result.size, axis, edges[axis]);
    });
    result.file = nullptr, result.memory = nullptr;
  }
  return result;
}

}  // namespace pendular
