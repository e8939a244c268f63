#pragma once

#include <cstddef>
#include <cstdint>

#include "dem_core/simulation.h"
#include "dem_core/step/listed.h"
#include "dem_core/step/quanta.h"

namespace pendular::dem_core {

/// What the platens do to a bead in one step, in quanta.
struct Pressed {
  std::int64_t force[3] = {}, torque[3] = {};
  std::int64_t bottom = 0, top = 0;  ///< on the platens
  std::int64_t damped = 0, slipped = 0;
};

/// Advances what the platens remember of the bead.
Pressed press(Simulation& simulation, std::size_t bead, const BeadMotion& motion, NearPlatens near,
              const PerQuantum& per);

}  // namespace pendular::dem_core
