#include "dem_core/bond_bodies.h"

#include <algorithm>

namespace pendular::dem_core {

std::vector<Bridge> standing_bridges(const Packing& packing) {
  std::vector<Bridge> standing;
  for (const auto& bridge : packing.bridges)
    if (bridge.state == BridgeState::candidate || bridge.state == BridgeState::bridge)
      standing.push_back(bridge);
  return standing;
}

std::vector<micromechanics::BridgeBody> bond_bodies(const Packing& packing,
                                                    const std::vector<Bridge>& standing,
                                                    const Sample& sample) {
  std::vector<micromechanics::BridgeBody> bodies;
  for (const auto& bridge : standing) {
    const Bead &a = packing.beads[bridge.i], &b = packing.beads[bridge.j];
    const bool own = sample.bridges.stiffness == StiffnessOf::per_bridge && bridge.diameter > 0.0;
    const double neck = own ? bridge.diameter : sample.bridges.diameter;
    bodies.push_back(
        {std::min(neck, 0.99 * std::min(a.diameter, b.diameter)), gap(a, b), a.diameter, b.diameter});
  }
  return bodies;
}

}  // namespace pendular::dem_core
