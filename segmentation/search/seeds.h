#pragma once

#include <vector>

#include "segmentation/search/grid.h"

namespace pendular::segmentation {

/// Where a bead may be, to within about two nodes; voxels of the full volume.
struct Seed {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

/// Bodies of the mask: maxima of its distance map from the highest down, except those that lie within
/// another's ball or at its neck (nearer than its radius plus half their own). Left out are those smaller
/// than `least_radius` voxels, and what of a body is 158 nodes and more from its surface, or has none.
std::vector<Seed> find_seeds(const Grid<std::uint8_t>& mask, double least_radius);

/// The radius that halves the total volume of the seeds' balls: what most of the material is made of.
double typical_radius(const std::vector<Seed>& seeds);

}  // namespace pendular::segmentation
