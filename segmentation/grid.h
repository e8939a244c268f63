#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "segmentation/volume.h"

namespace pendular {

/// A volume reduced by a whole factor, on which beads and container are looked for. Positions anywhere in
/// segmentation are in voxels of the full volume; node (i, j, k) lies at at(i, j, k).
template <typename T>
struct Grid {
  std::array<std::size_t, 3> size{};
  std::size_t factor = 1;  ///< voxels of the full volume per node, along each axis
  std::vector<T> values;   ///< x running fastest

  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (k * size[1] + j) * size[0] + i;
  }
  Vec3 at(std::size_t i, std::size_t j, std::size_t k) const {
    const double f = static_cast<double>(factor);
    return Vec3((static_cast<double>(i) + 0.5) * f - 0.5, (static_cast<double>(j) + 0.5) * f - 0.5,
                (static_cast<double>(k) + 0.5) * f - 0.5);
  }
};

/// Means over blocks of factor³ voxels, convolved with a Gaussian of standard deviation `sd` nodes (ITK's
/// recursive one), edges continued. What is left over at the far ends is dropped; a grid of less than four
/// nodes along an axis is not convolved.
Grid<float> reduced(const Volume& volume, std::size_t factor, double sd);

/// For each node with a nonzero mask the distance, in nodes, to the surface of the mask; elsewhere not
/// positive (ITK's signed Maurer map, on one thread). What lies outside the grid counts as neither.
Grid<float> distance_inside(const Grid<std::uint8_t>& mask);

}  // namespace pendular
