#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// A standing bond at a moment when it may change; SI.
struct BondMoment {
  double stretch;  ///< of its normal spring: the gap, or touch where the glass is closed, less rest
  double shear;    ///< |δt|
  double height;   ///< l
  double elapsed;  ///< since it last might, s
  Vec3 normal;     ///< from bead j to bead i
  PairProperties& properties;
  PairHistory& history;
  double* memory;  ///< its numbers of Simulation::bond_memory, 0 at first
};

/// How bonds change as a test goes on: every small strain, between steps, so that the law within a step stays
/// the same for all.
struct BondEvolution {
  std::size_t memory = 0;  ///< numbers that each bond remembers
  std::function<void(const BondMoment&)> change;
  std::function<void(std::span<const BondMoment>)> change_all = {};  ///< the same of all at once, after it

  bool any() const { return change || change_all; }
};

/// Changes one bond, and books the change of its energy as Work::given.
void change_bond(Simulation& simulation, Pair& pair, const BondEvolution& evolution, double elapsed);

/// The same of all standing bonds at once; `pairs` are theirs, sorted by bond.
void change_all_bonds(Simulation& simulation, std::span<Pair* const> pairs, const BondEvolution& evolution,
                      double elapsed);

}  // namespace pendular::dem_core
