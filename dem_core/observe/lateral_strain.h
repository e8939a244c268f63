#pragma once

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// Lateral strain at mid-height, expansion positive: what a pair of callipers around the specimen's middle
/// would read. Over the outer beads of the middle third of the height that still have a bond, with lateral
/// places r and displacements u taken from their means, it is Σ u·r / Σ r·r: the least-squares radial
/// expansion u = ε r, in which shift and rotation of the specimen do not count. Outer: at the start within
/// one mean diameter of the outermost bead of the middle third, from the beads' mean axis. Zero where fewer
/// than three such beads are left.
double lateral_strain(const Simulation& simulation);

}  // namespace pendular::dem_core
