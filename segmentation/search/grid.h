#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "volume/volume.h"

namespace pendular::segmentation {

/// A volume reduced by a whole factor, or refined, on which beads and container are looked for. Positions
/// anywhere in segmentation are in voxels of the full volume; node (i, j, k) lies at at(i, j, k).
template <typename T>
struct Grid {
  std::array<std::size_t, 3> size{};
  double factor = 1.0;                  ///< voxels of the full volume per node, along each axis
  std::vector<T> values;                ///< x running fastest
  double first = 0.5 * (factor - 1.0);  ///< where node (0, 0, 0) lies, along each axis

  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (k * size[1] + j) * size[0] + i;
  }
  Vec3 at(std::size_t i, std::size_t j, std::size_t k) const {
    return Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) * factor +
           Vec3::Constant(first);
  }
};

/// A part of a grid or volume: from `low` to below `high`.
struct Box {
  std::array<std::size_t, 3> low{}, high{};
  bool operator==(const Box&) const = default;
};

/// That part as a grid of its own, its first node at what `low` is in the whole.
template <typename T>
Grid<T> part_of(const Grid<T>& grid, const Box& box) {
  Grid<T> part{{}, grid.factor, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) part.size[axis] = box.high[axis] - box.low[axis];
  part.values.reserve(part.size[0] * part.size[1] * part.size[2]);
  for (std::size_t k = box.low[2]; k < box.high[2]; ++k)
    for (std::size_t j = box.low[1]; j < box.high[1]; ++j) {
      const auto row = grid.values.begin() + static_cast<std::ptrdiff_t>(grid.index(box.low[0], j, k));
      part.values.insert(part.values.end(), row, row + static_cast<std::ptrdiff_t>(part.size[0]));
    }
  return part;
}

/// Means over blocks of factor³ voxels, convolved with a Gaussian of standard deviation `sd` nodes (ITK's
/// recursive one), edges continued. What is left over at the far ends is dropped; a grid of less than four
/// nodes along an axis is not convolved.
Grid<float> reduced(const Volume& volume, std::size_t factor, double sd);

}  // namespace pendular::segmentation
