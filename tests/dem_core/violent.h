#pragma once

#include <cstdint>

#include "base/random.h"
#include "dem_core/simulation.h"

namespace pendular::test {

/// A specimen in violent motion: every bead with a random velocity and spin, pressed between its platens.
inline dem_core::Simulation violent(const Sample& sample, const Packing& packing, double k_bend = 0.0) {
  dem_core::Simulation simulation = dem_core::build_simulation(packing, sample);
  auto& beads = simulation.beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const auto id = static_cast<std::uint64_t>(packing.beads[k].id);
    beads.velocity[k] = 20.0 * Vec3(random_normal(1, id), random_normal(2, id), random_normal(3, id));
    beads.spin[k] = 1e5 * Vec3(random_normal(4, id), random_normal(5, id), random_normal(6, id));
  }
  for (auto& pair : simulation.pairs) {
    if (pair.bond < 0) continue;
    pair.properties.k_bend = 2.0 * k_bend;
    pair.properties.k_twist = k_bend;
  }
  simulation.law.bending = k_bend > 0.0;
  return simulation;
}

}  // namespace pendular::test
