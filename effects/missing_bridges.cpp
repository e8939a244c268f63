#include "effects/effect.h"

namespace pendular::effects {
namespace {

void remove(Packing& packing, double theta, const Draws& draws) {
  for (auto& bridge : packing.bridges)
    if (bridge.state == BridgeState::candidate && draws.uniform(of_pair(bridge.i, bridge.j)) < theta)
      bridge.state = BridgeState::none;
}

}  // namespace

/// The paper bonds every pair closer than the cut-off. In a real specimen some have no polymer between them:
/// each candidate is absent with probability θ, and what is absent at a smaller θ is at a larger one. Bridges
/// that were measured stay. Lowers E, Z and the peak.
Effect missing_bridges() {
  return {.id = "missing_bridges",
          .unit = "fraction",
          .name = "bridges missing between near beads",
          .sentence = "Some pairs of beads that are near enough for a bridge have none.",
          .meaning = "share of the candidate pairs without a bridge",
          .lowest = 0.0,
          .highest = 0.9,
          .bank_from = 0.0,
          .bank_to = 0.3,
          .draws = true,
          .packing = remove};
}

}  // namespace pendular::effects
