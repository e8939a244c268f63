#pragma once

#include "dem_core/drive/bond_evolution.h"

namespace pendular::dem_core {

/// What a test asks of that which advances its simulation, between two steps.
class Stepping {
 public:
  virtual ~Stepping() = default;

  /// Writes beads and pairs back to the simulation.
  virtual void store() = 0;

  /// Lets the standing bonds change by what has become of them in a time (s). Books what that brings as
  /// Work::given.
  virtual void change_bonds(const BondEvolution& evolution, double elapsed) = 0;
};

}  // namespace pendular::dem_core
