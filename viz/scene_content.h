#pragma once

#include <cstddef>
#include <vector>

#include "viz/scene.h"

// Which beads and pairs of a frame a view shows, and their values. Internal to viz.

namespace pendular::viz {

/// Towards the camera: with the dip to the right and z up.
Vec3 towards_camera(const Stage& stage);

/// Whether a bead lies behind the cutting plane of a view that has one; before loading, so that the choice
/// does not change from frame to frame.
bool is_shown(const View& view, const Frame& frame, const Stage& stage, int bead);

/// In the unit of the view's colour bar.
double bead_value(const View& view, const Frame& frame, std::size_t bead);

/// Pairs of the strong network (above the mean compressive force; Radjai et al. 1998, Phys. Rev. Lett. 80,
/// 61) in a slab three beads thick behind the cutting plane.
std::vector<std::size_t> strong_pairs(const Frame& frame, const Stage& stage);

}  // namespace pendular::viz
