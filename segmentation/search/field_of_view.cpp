#include "segmentation/search/field_of_view.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace pendular::segmentation {
namespace {

/// Greatest distance from the middle, squared, of a voxel of slice k that differs from `value`.
template <typename T>
double reach_of(std::span<const Grey<T>> pixels, const Volume& volume, std::size_t k, T value, double x,
                double y) {
  double reach = 0.0;
  for (std::size_t j = 0; j < volume.size[1]; ++j) {
    const auto row = pixels.subspan((k * volume.size[1] + j) * volume.size[0], volume.size[0]);
    const auto differs = [&](T grey) { return grey != value; };
    const auto first = std::find_if(row.begin(), row.end(), differs);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), differs);
    const double dy = static_cast<double>(j) - y;
    const double dx = std::max(std::abs(static_cast<double>(first - row.begin()) - x),
                               std::abs(static_cast<double>(row.rend() - last - 1) - x));
    reach = std::max(reach, dx * dx + dy * dy);
  }
  return reach;
}

double voxels_beyond(const Volume& volume, const FieldOfView& view) {
  double within = 0.0;
  for (std::size_t j = 0; j < volume.size[1]; ++j) {
    const double dy = static_cast<double>(j) - view.y, square = view.radius * view.radius - dy * dy;
    if (square < 0.0) continue;
    const double half = std::sqrt(square), last = static_cast<double>(volume.size[0]) - 1.0;
    within += std::floor(std::min(last, view.x + half)) - std::ceil(std::max(0.0, view.x - half)) + 1.0;
  }
  return static_cast<double>(volume.voxels()) - within * static_cast<double>(volume.size[2]);
}

}  // namespace

std::optional<FieldOfView> field_of_view(const Volume& volume) {
  constexpr std::size_t slices = 32;
  FieldOfView view{0.5 * (static_cast<double>(volume.size[0]) - 1.0),
                   0.5 * (static_cast<double>(volume.size[1]) - 1.0)};
  const double inscribed = 0.5 * static_cast<double>(std::max(volume.size[0], volume.size[1])) + 2.0;
  double reach = 0.0;
  with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    const T value = pixels[0];
    view.value = static_cast<double>(value);
    const std::size_t step = volume.size[2] / slices + 1;
    for (std::size_t k = 0; k < volume.size[2] && reach <= inscribed * inscribed; k += step)
      reach = std::max(reach, reach_of(pixels, volume, k, value, view.x, view.y));
  });
  if (reach == 0.0 || reach > inscribed * inscribed) return std::nullopt;
  view.radius = std::sqrt(reach);
  view.voxels_beyond = voxels_beyond(volume, view);
  if (view.voxels_beyond <= 0.0) return std::nullopt;
  return view;
}

void leave_out(Histogram& histogram, const FieldOfView& view) {
  const auto bin = static_cast<std::size_t>((view.value - histogram.lowest) / histogram.width);
  double& count = histogram.counts[std::min(bin, histogram.counts.size() - 1)];
  count = std::max(0.0, count - view.voxels_beyond);
}

void fill_beyond(Grid<float>& grey, const FieldOfView& view) {
  // Nodes nearer to the edge than this have been blended with what is beyond.
  const double factor = grey.factor, within = view.radius - 3.0 * factor;
  const auto distance = [&](std::size_t i, std::size_t j) {
    const Vec3 p = grey.at(i, j, 0);
    return std::hypot(p.x() - view.x, p.y() - view.y);
  };
  double sum = 0.0, count = 0.0;
  for (std::size_t j = 0; j < grey.size[1]; ++j)
    for (std::size_t i = 0; i < grey.size[0]; ++i) {
      if (const double r = distance(i, j); r > within || r < within - 2.0 * factor) continue;
      for (std::size_t k = 0; k < grey.size[2]; ++k) sum += grey.values[grey.index(i, j, k)];
      count += static_cast<double>(grey.size[2]);
    }
  if (count == 0.0) return;
  const auto mean = static_cast<float>(sum / count);
  for_blocks(grey.size[2], 1, [&](std::size_t k, std::size_t) {
    for (std::size_t j = 0; j < grey.size[1]; ++j)
      for (std::size_t i = 0; i < grey.size[0]; ++i)
        if (distance(i, j) > within) grey.values[grey.index(i, j, k)] = mean;
  });
}

}  // namespace pendular::segmentation
