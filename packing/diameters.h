#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.h"

namespace pendular {

/// Bead diameters for given centres, as drawn by Hemmerle et al. 2021 (Sec. 3.2.1): Gaussian (Box–Muller),
/// limited so that no pair overlaps.
///
/// All start at `mean`. Then each bead once, in a random order, takes a draw from N(mean, relative_sd ×
/// mean), or where that overlaps a neighbour as it is then, the largest diameter that fits. A bead thus
/// either has its draw or touches a neighbour when it is visited; neighbours visited later may shrink away
/// from it. Draws below half the mean count as that, and no diameter exceeds 1.5 times the distance to the
/// nearest centre (which only centres closer than 2/3 of a diameter ever notice), so that all are positive.
///
/// The paper's one sentence can be read in other ways; docs/model.md holds those tried against each other.
///
/// Same unit for centres and diameters. Deterministic in `seed`. BadInput where two centres coincide.
std::vector<double> draw_diameters(std::span<const Vec3> centres, double mean, double relative_sd,
                                   std::uint64_t seed);

}  // namespace pendular
