#pragma once

#include <vector>

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// A platen on one bead it acts on.
struct PlatenContact {
  std::size_t bead = 0;
  Vec3 force = Vec3::Zero();  ///< on the bead, N
};

/// All forces at one moment, N: those that the next step will apply, by the same laws.
struct Forces {
  std::vector<Vec3> pair;  ///< on bead i of each of Simulation::pairs; zero where it does not act
  std::vector<PlatenContact> bottom, top;
  std::vector<Vec3> net;  ///< on each bead
};

/// Reads the simulation and leaves it as it is.
Forces forces(const Simulation& simulation);

}  // namespace pendular::dem_core
