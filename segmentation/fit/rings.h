#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "segmentation/fit/ball_fit.h"

namespace pendular::segmentation {

/// Rings about the axis of rotation, which faults of a detector leave: grey values that depend on a voxel's
/// slice and on its distance from the axis alone, in steps of a quarter of a voxel.
struct Rings {
  std::size_t width = 0, steps = 0;  ///< voxels along x; distances
  std::vector<std::uint32_t> step;   ///< of each voxel of a slice
  std::vector<float> grey;           ///< of each distance, slice by slice; NaN where no core tells
  double rms = 0.0;                  ///< of them, grey values

  /// NaN where it is not known.
  double at(std::size_t i, std::size_t j, std::size_t k) const {
    return static_cast<double>(grey[k * steps + step[j * width + i]]);
  }
};

/// Of a voxel among those of the volume.
inline std::size_t place_of(const Volume& volume, long i, long j, long k) {
  const auto x = static_cast<std::size_t>(i), y = static_cast<std::size_t>(j),
             z = static_cast<std::size_t>(k);
  return (z * volume.size[1] + y) * volume.size[0] + x;
}

/// The grey value of a voxel of the volume without its ring, if there are any; NaN where that is not known.
template <typename T>
double grey_at(std::span<const T> pixels, const Volume& volume, const Rings* rings, long i, long j, long k) {
  const auto grey = static_cast<double>(pixels[place_of(volume, i, j, k)]);
  return rings ? grey - rings->at(static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                                  static_cast<std::size_t>(k))
               : grey;
}

/// Rings about the middle of the picture, from what the cores of the balls (all but `margin` voxels of their
/// outer part) leave beside their means: a part that all slices share, with means and rings fitted together
/// by least squares, and one of each slice. Either is told from noise by its covariance between every other
/// ball and the rest, must be five standard errors of it, and is shrunk towards zero as noise asks (Wiener).
/// Nothing where neither shows, or where both are fainter than a seventh of the noise.
std::shared_ptr<const Rings> find_rings(const Volume& volume, std::span<const GreyBall> balls, double margin);

}  // namespace pendular::segmentation
