#pragma once

#include <optional>

#include "segmentation/search/grid.h"

namespace pendular::segmentation {

/// What surrounds the beads in the picture, in voxels of the full volume.
struct Container {
  double axis_x = 0.0, axis_y = 0.0;  ///< of the tube, along z
  double radius = 0.0;                ///< inner, of the tube
  std::optional<double> bottom,
      top;  ///< z of the pistons' faces; none: the beads end free or the picture ends
};

/// The tube around the beads and the pistons below and above, from the mean and the spread of grey values
/// along z (tube) and within slices (pistons): beads make both vary, walls do not. None where no tube is seen
/// on all sides.
std::optional<Container> find_container(const Grid<float>& grey);

/// Whether a point lies inside the tube and between the pistons.
bool within(const Container& container, const Vec3& p);

/// Clears the mask outside the tube and beyond the pistons.
void clear_outside(Grid<std::uint8_t>& mask, const Container& container);

}  // namespace pendular::segmentation
