#include <algorithm>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void fill(dem_core::Simulation& simulation, double theta) {
  for (auto& pair : simulation.pairs)
    if (pair.bond >= 0)
      pair.properties.touch = std::max(pair.properties.touch, std::min(pair.properties.rest, 1e-6 * theta));
}

}  // namespace

/// Grains of dust, θ across, lie between the beads of each bridge: they touch through it when they are that
/// near, and those that are nearer from the start do so at once. Raises E.
Mechanism grit() {
  return {.id = "grit",
          .kind = "contacts",
          .unit = "um",
          .meaning = "size of grains between bridged beads",
          .from = 2.0,
          .to = 8.0,
          .simulation = fill};
}

}  // namespace pendular::blind
