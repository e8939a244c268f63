#pragma once

#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "base/sample.h"
#include "packing/bridges.h"
#include "packing/packing.h"

namespace pendular::test {

/// Sample A with the paper's stiffness and its packings' diameters as they are.
inline Sample sample_a() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.beads.diameters = Diameters::measured;
  return sample;
}

/// Columns of beads on a square grid with equal gaps, so that a column is a chain of springs.
inline Packing columns(int side, int tall, double gap_over_d) {
  const double d = 200.9e-6, pitch = d * (1.0 + gap_over_d);
  Packing packing;
  for (int k = 0; k < tall; ++k)
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        Bead bead;
        bead.id = static_cast<std::int64_t>(packing.beads.size()) + 1;
        bead.centre = pitch * Vec3(i, j, k);
        bead.diameter = d;
        packing.beads.push_back(bead);
      }
  packing.bridges = candidate_bridges(packing.beads, 0.064 * d);
  packing.specimen.diameter = 1.13 * side * pitch;
  packing.specimen.height = tall * pitch;
  return packing;
}

/// A small disordered specimen: face-centred cubic, with each bead a little smaller at random.
inline Packing disordered(int side, int tall) {
  const double d = 200.9e-6, a = std::sqrt(2.0) * d;
  Packing packing;
  const Vec3 basis[4] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  for (int k = 0; k < tall; ++k)
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        for (const auto& offset : basis) {
          Bead bead;
          const auto n = static_cast<std::uint64_t>(packing.beads.size());
          bead.id = static_cast<std::int64_t>(n) + 1;
          bead.centre = a * (Vec3(i, j, k) + offset);
          bead.diameter = d * (1.0 - 0.03 * random_uniform(11, n));
          packing.beads.push_back(bead);
        }
  packing.bridges = candidate_bridges(packing.beads, 0.064 * d);
  return packing;
}

}  // namespace pendular::test
