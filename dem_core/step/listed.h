#pragma once

#include <cstddef>
#include <vector>

#include "dem_core/simulation.h"
#include "dem_core/step/step_tables.h"

namespace pendular::dem_core {

// How what a simulation lists goes into the tables of a stepper.

/// Beads in an order that keeps neighbours in space close (Morton's), of which one half is half of the
/// specimen, cut off by a plane.
std::vector<std::size_t> beads_in_space(const Simulation& simulation);

/// Of each pair, whether its glass may touch before the next listing.
std::vector<char> touchable(const Simulation& simulation);

/// The pair of two beads, i < j, or none.
Pair* find_pair(Simulation& simulation, int i, int j);

/// Which platens a bead may touch before the next listing.
struct NearPlatens {
  bool bottom, top;
};
NearPlatens near_platens(const Simulation& simulation, std::size_t bead);

/// Whether a bead or a platen may have moved by its margin; `farthest` is the largest displacement of a bead
/// over its margin, squared.
bool listing_due(const Simulation& simulation, double farthest);

/// Where a table has a pair; contact and bend may be absent.
struct PairPlace {
  PairColumns* columns;
  ContactBlock* contact;
  BendBlock* bend;
};
void put_pair(const Pair& pair, const PairPlace& to, std::size_t at);

/// What the pair remembers.
void get_pair(const PairPlace& from, std::size_t at, Pair& pair);

void put_bead(const Platen& platen, std::size_t bead, PlatenColumns& to, std::size_t at);

/// What the platen remembers of the bead.
void get_bead(const PlatenColumns& from, std::size_t at, std::size_t bead, Platen& platen);

}  // namespace pendular::dem_core
