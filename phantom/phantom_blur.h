#pragma once

// Separable Gaussian smoothing of an image that exists a few slices at a time. Internal to segmentation.

#include <cstddef>
#include <span>
#include <vector>

namespace pendular::phantom {

/// Half of a sampled Gaussian of standard deviation `sd` voxels, weights[0] in the middle, cut off at 4 sd,
/// its whole summing to 1. Its variance is sd² within 1 % for sd ≥ 0.45; sd = 0 leaves an image as it is.
struct GaussianKernel {
  explicit GaussianKernel(double sd);
  int radius() const { return static_cast<int>(weights.size()) - 1; }
  /// Σ w² over the whole kernel: the factor by which smoothing along one axis scales white noise's variance.
  double sum_of_squares() const;

  std::vector<float> weights;
};

/// Smooths a slice (nx × ny, x fastest) along x and y in place, as if it went on periodically, so that noise
/// is as strong at the edges as elsewhere; `scratch` is as long as the slice.
void smooth_slice(std::span<float> slice, int nx, int ny, const GaussianKernel& kernel,
                  std::span<float> scratch);

/// The latest slices of an image too large to hold: slice z stays until slice z + depth takes its place.
class SliceRing {
 public:
  SliceRing(std::size_t voxels_per_slice, int depth)
      : size_(voxels_per_slice), depth_(depth), data_(voxels_per_slice * static_cast<std::size_t>(depth)) {}

  /// `z` may be negative, down to −depth.
  std::span<float> slice(int z) {
    return std::span(data_).subspan(static_cast<std::size_t>((z + depth_) % depth_) * size_, size_);
  }

  /// The part [first, first + out.size()) of slice z smoothed along z; needs slices z ± kernel.radius().
  void smoothed(int z, std::size_t first, const GaussianKernel& kernel, std::span<float> out);

 private:
  std::size_t size_;
  int depth_;
  std::vector<float> data_;
};

}  // namespace pendular::phantom
