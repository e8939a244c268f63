#include "segmentation/rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/parallel.h"

namespace pendular::segmentation {

std::pair<std::size_t, std::size_t> row_within(const Volume& volume, const std::optional<Specimen>& specimen,
                                               std::size_t j, std::size_t k) {
  if (!specimen) return {0, volume.size[0]};
  const double z = volume.origin.z() + volume.spacing * static_cast<double>(k);
  const double y = volume.origin.y() + volume.spacing * static_cast<double>(j) - specimen->axis_y;
  const double half = 0.25 * specimen->diameter * specimen->diameter - y * y;
  if (half <= 0.0 || z < specimen->bottom || z > specimen->bottom + specimen->height) return {0, 0};
  const double n = static_cast<double>(volume.size[0]);
  const auto voxel = [&](double x) { return (x + specimen->axis_x - volume.origin.x()) / volume.spacing; };
  const double first = std::clamp(std::ceil(voxel(-std::sqrt(half))), 0.0, n);
  const double last = std::clamp(std::floor(voxel(std::sqrt(half))) + 1.0, first, n);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(last)};
}

double porosity_of(const Volume& volume, const std::optional<Specimen>& specimen, double threshold,
                   bool bright_beads) {
  std::vector<std::size_t> air(volume.size[2], 0), all(volume.size[2], 0);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(volume.size[2], 1, [&](std::size_t k, std::size_t) {
      for (std::size_t j = 0; j < volume.size[1]; ++j) {
        const auto [first, last] = row_within(volume, specimen, j, k);
        const auto* row = pixels.data() + (k * volume.size[1] + j) * volume.size[0];
        all[k] += last - first;
        for (std::size_t i = first; i < last; ++i)
          air[k] += (static_cast<double>(row[i]) > threshold) != bright_beads;
      }
    });
  });
  const auto sum = [](const std::vector<std::size_t>& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
  };
  return sum(all) > 0.0 ? sum(air) / sum(all) : 0.0;
}

}  // namespace pendular::segmentation
