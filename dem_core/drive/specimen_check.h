#pragma once

#include "dem_core/simulation.h"
#include "packing/packing.h"

namespace pendular::dem_core {

/// BadInput, naming beads, for a specimen that cannot be compressed:
/// - two beads overlap by more than measurement explains: more than 5 % of their mean diameter and more than
///   five standard errors of their gap;
/// - no network of bonds and of pairs that may touch joins the platens. Of the height, a
///   network may leave free what the platen travels (`max_strain`) and one mean diameter.
void check_specimen(const Packing& packing, const Simulation& simulation, double max_strain);

}  // namespace pendular::dem_core
