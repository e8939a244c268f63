#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "segmentation/rows.h"
#include "segmentation/search/padding.h"
#include "segmentation/segment.h"

namespace pendular::segmentation {
namespace {

/// Beads by cubic cells of the volume; each cell knows every bead that may own one of its voxels.
class Owners {
 public:
  Owners(const Volume& volume, const std::vector<Bead>& bodies) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Bead& bead : bodies) {
      balls_.push_back(
          {(bead.centre - volume.origin) / volume.spacing, 0.5 * bead.diameter / volume.spacing});
      smallest = std::min(smallest, balls_.back().radius);
    }
    width_ = std::max<std::size_t>(4, static_cast<std::size_t>(smallest));
    for (int axis = 0; axis < 3; ++axis) cells_[axis] = (volume.size[axis] + width_ - 1) / width_;
    candidates_.resize(cells_[0] * cells_[1] * cells_[2]);
    for_blocks(candidates_.size(), 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t cell = first; cell < last; ++cell) candidates_[cell] = candidates_of(cell);
    });
  }

  /// The bead, from 1, whose surface is nearest to voxel (i, j, k).
  std::uint32_t operator()(std::size_t i, std::size_t j, std::size_t k) const {
    const Vec3 p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t owner = 0;
    for (const std::uint32_t n :
         candidates_[((k / width_) * cells_[1] + j / width_) * cells_[0] + i / width_])
      if (const double d = (p - balls_[n].centre).norm() - balls_[n].radius; d < least) {
        least = d;
        owner = n + 1;
      }
    return owner;
  }

 private:
  struct Owner {
    Vec3 centre;
    double radius;
  };

  /// Those whose surface is no further from the cell's middle than the nearest one and the cell's diagonal.
  std::vector<std::uint32_t> candidates_of(std::size_t cell) const {
    const double w = static_cast<double>(width_);
    const std::size_t row = cell / cells_[0], layer = row / cells_[1];
    const Vec3 middle =
        w * Vec3(static_cast<double>(cell % cells_[0]) + 0.5, static_cast<double>(row % cells_[1]) + 0.5,
                 static_cast<double>(layer) + 0.5);
    std::vector<double> distance;
    for (const Owner& ball : balls_) distance.push_back((middle - ball.centre).norm() - ball.radius);
    const double limit = *std::min_element(distance.begin(), distance.end()) + std::sqrt(3.0) * w;
    std::vector<std::uint32_t> near;
    for (std::uint32_t n = 0; n < distance.size(); ++n)
      if (distance[n] <= limit) near.push_back(n);
    return near;
  }

  std::vector<Owner> balls_;
  std::size_t width_ = 1;
  std::array<std::size_t, 3> cells_{};
  std::vector<std::vector<std::uint32_t>> candidates_;
};

template <typename Label>
std::vector<Label> labels_of(const Volume& volume, const Segmentation& segmentation) {
  std::vector<Bead> bodies = segmentation.beads;
  bodies.insert(bodies.end(), segmentation.grains.begin(), segmentation.grains.end());
  const Owners owner(volume, bodies);
  const Box box = without_padding(volume);
  std::vector<Label> labels(volume.voxels(), 0);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(box.high[2] - box.low[2], 1, [&](std::size_t slice, std::size_t) {
      const std::size_t k = box.low[2] + slice;
      for (std::size_t j = box.low[1]; j < box.high[1]; ++j) {
        const auto [first, last] = row_within(volume, segmentation.specimen, j, k);
        const std::size_t row = (k * volume.size[1] + j) * volume.size[0];
        for (std::size_t i = std::max(first, box.low[0]); i < std::min(last, box.high[0]); ++i)
          if ((static_cast<double>(pixels[row + i]) > segmentation.levels.threshold) ==
              segmentation.bright_beads)
            labels[row + i] = static_cast<Label>(owner(i, j, k));
      }
    });
  });
  return labels;
}

}  // namespace

Volume label_volume(const Volume& volume, const Segmentation& segmentation) {
  Volume labels{volume.size, volume.spacing, volume.origin, {}};
  if (segmentation.beads.size() + segmentation.grains.size() <= std::numeric_limits<std::uint16_t>::max())
    labels.pixels = labels_of<std::uint16_t>(volume, segmentation);
  else
    labels.pixels = labels_of<std::uint32_t>(volume, segmentation);
  return labels;
}

}  // namespace pendular::segmentation
