#pragma once

#include <cstdint>

#include "segmentation/search/grid.h"

namespace pendular::segmentation {

/// For each node with a nonzero mask the distance, in nodes, to the surface of the mask: to the nearest node
/// of the mask with a neighbour (of 26) that is none, and the half node from there to the surface. Elsewhere
/// zero. What lies outside the grid counts as neither; the greatest number where there is no surface within
/// 10,000 nodes along each axis.
///
/// Exact, one axis after the other (Saito & Toriwaki 1994): squares along x, then for each node the least of
/// the squares on its line along y and along z plus the square of the way there. A node looks no farther than
/// its own square, or its neighbour's distance and one, allow.
Grid<float> distance_inside(const Grid<std::uint8_t>& mask);

}  // namespace pendular::segmentation
