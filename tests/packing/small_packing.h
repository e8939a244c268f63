#pragma once

#include "base/random.h"
#include "packing/bridges.h"
#include "packing/packing.h"

namespace pendular::test {

/// Beads on a jittered cubic lattice, apart from each other, with every field set to something of its own.
inline Packing small_packing(int per_side = 5) {
  constexpr double spacing = 230e-6;
  Packing packing;
  std::uint64_t draw = 0;
  const auto uniform = [&] { return random_uniform(11, draw++); };
  for (int k = 0; k < per_side * per_side * per_side; ++k) {
    const Vec3 cell(k % per_side, k / per_side % per_side, k / per_side / per_side);
    const Vec3 jitter(uniform(), uniform(), uniform());
    const double diameter = (190.0 + 10.0 * uniform()) * 1e-6;
    packing.beads.push_back({3 * k + 7, spacing * (cell + 0.05 * jitter), diameter, 1e-6 * uniform(),
                             2e-6 * uniform(), uniform(), k % 3 == 0});
  }
  packing.bridges = candidate_bridges(packing.beads, 45e-6);
  int state = 0;
  for (auto& bridge : packing.bridges) {
    bridge.probability = uniform();
    bridge.diameter = 70e-6 * uniform();
    bridge.sigma_diameter = 1e-6 * uniform();
    bridge.state = static_cast<BridgeState>(state++ % 4);
  }
  packing.specimen = {1.5e-3, 1.25e-3, 0.47e-3, 0.5e-3, -0.11e-3};
  packing.provenance = {"0.1.0", "pendular pack \"a b\".csv", 5, {{"a.csv", "00ff"}}};
  return packing;
}

}  // namespace pendular::test
