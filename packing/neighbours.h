#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/vec3.h"

namespace pendular {

using IndexPair = std::pair<int, int>;

/// Every pair i < j of spheres whose surface separation is below `max_gap` (which may be negative), sorted by
/// (i, j). Linear time by a cell list. `diameters` is as long as `centres`; any unit, the same for all three.
std::vector<IndexPair> pairs_within(std::span<const Vec3> centres, std::span<const double> diameters,
                                    double max_gap);

}  // namespace pendular
