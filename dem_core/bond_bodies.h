#pragma once

#include <vector>

#include "base/sample.h"
#include "micromechanics/bridge_body.h"
#include "packing/packing.h"

namespace pendular::dem_core {

/// The bridges of a packing that build_simulation() makes bonds of: those in state `candidate` or `bridge`,
/// in the packing's order, which is that of Simulation::bonds.
std::vector<Bridge> standing_bridges(const Packing& packing);

/// Their bodies. A neck is the bridge's own where the sample asks for that and it was measured, the mean one
/// otherwise; thinner than both beads.
std::vector<micromechanics::BridgeBody> bond_bodies(const Packing& packing,
                                                    const std::vector<Bridge>& standing,
                                                    const Sample& sample);

}  // namespace pendular::dem_core
