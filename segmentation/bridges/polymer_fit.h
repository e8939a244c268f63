#pragma once

#include <optional>

#include "segmentation/fit/bead_fit.h"

namespace pendular::segmentation {

/// Fits beads once more with what is between them known, where noise makes it worth while: where the typical
/// standard error of a centre is above 0.015 voxel. Cones that may hold polymer are up to two thirds of a
/// bead's surface; here polymer is measured first (bridge_search.h), then its blurred image and that of the
/// neighbours are subtracted, and cones are left out only towards neighbours of which it cannot be told
/// whether there is polymer. Where none is seen there are none, if there is less than three per cent of the
/// beads' contrast; else nothing is done. `cutoff`: gaps below cutoff × D may hold polymer.
void fit_with_polymer(const Volume& volume, const std::optional<Container>& container, double cutoff,
                      FittedBeads& fitted);

}  // namespace pendular::segmentation
