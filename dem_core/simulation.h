#pragma once

#include <cstdint>
#include <vector>

#include "base/sample.h"
#include "dem_core/law/pair.h"
#include "dem_core/law/platen.h"
#include "packing/packing.h"

namespace pendular::dem_core {

/// Beads of a running simulation, in the packing's order; SI. Velocities are half a step behind positions
/// (leapfrog), what pairs remember is one step behind.
struct BeadStates {
  std::vector<Vec3> position, velocity, spin;
  std::vector<double> radius, mass, inertia;
  std::vector<Vec3> start;  ///< positions before the test
  std::size_t size() const { return position.size(); }
  double mean_diameter() const;
  BeadMotion motion(std::size_t k) const { return {position[k], velocity[k], spin[k], radius[k]}; }
};

/// A pair that may act: every bonded pair, and every pair that may touch before pairs are listed anew.
struct Pair {
  int i = 0, j = 0;  ///< i < j
  int bond = -1;     ///< index into Simulation::bonds while the bond stands
  PairProperties properties;
  PairHistory history = {};
};

/// A bond of the packing.
struct Bond {
  int i = 0, j = 0;
  bool broken = false;
  double height = 0.0;  ///< l of the breaking criterion, m
};

/// A bond that has broken, as events.csv reports it.
struct BreakEvent {
  double strain = 0.0;
  int i = 0, j = 0;
  Vec3 place;
  double stretch = 0.0;  ///< Δr_n, m
  double shear = 0.0;    ///< |δt|, m
  double energy = 0.0;   ///< released, J
};

/// Running totals, J.
struct Work {
  double platen = 0.0;  ///< done by the platens
  double damped = 0.0, slipped = 0.0, broken = 0.0;
  double halted = 0.0;  ///< taken out by bringing beads to rest, in quasi-static tests
  double given = 0.0;   ///< brought by what bonds became of themselves: before the test, or as it went on
};

/// For which places the list of pairs holds: as long as no bead and no platen has moved by more than its
/// margin. Margins follow speed, so that a few loose beads that fly do not have all pairs listed anew, and
/// those at rest are not listed with neighbours that they will not touch.
struct Listing {
  std::vector<Vec3> at;                  ///< positions of the beads, as single precision has them
  std::vector<double> margin;            ///< of the beads, m
  double bottom_at = 0.0, top_at = 0.0;  ///< places of the platens' faces, m
  double platen_margin = 0.0;            ///< m
};

struct Simulation {
  LawParameters law;
  double stiffest = 0.0;  ///< of all springs before the test, N/m: what forces are measured by
  double dt = 0.0;
  std::int64_t steps = 0;
  BeadStates beads;
  std::vector<Pair> pairs;  ///< sorted by (i, j)
  std::vector<Bond> bonds;
  std::vector<double> bond_memory;  ///< what laws that change bonds remember: as many numbers for each
  Platen bottom, top;
  double initial_height = 0.0;  ///< distance of the platens at the start, m
  double section = 0.0;         ///< initial cross-section, m²
  Listing listing;
  std::vector<BreakEvent> events;
  Work work;

  /// Engineering strain: platen displacement over initial height.
  double strain() const { return (initial_height - (top.z - bottom.z)) / initial_height; }
};

/// Energies at this moment, J.
struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;
};

/// A specimen between two platens that just touch it, at rest. The packing's diameters are used as they are;
/// pairs that overlap at the start (within measurement error) do not push. Bonds are the packing's bridges
/// in state `candidate` or `bridge`. BadInput where there is no bond or no bead.
Simulation build_simulation(const Packing& packing, const Sample& sample);

/// Platen speed that the sample asks for, m/s: given, or compression.speed × D √(k_glass/m) for the mean
/// bead.
double platen_speed(const Sample& sample);

/// Puts the platens where they just touch the outermost beads, with no memory of any; the bottom one moves at
/// `speed` (m/s). Keeps their relief.
void place_platens(Simulation& simulation, double speed);

/// A stated fraction of √(m_min/k_max), s, with k_max the stiffest of all springs.
double time_step(const Simulation& simulation, double fraction);

/// Lists anew the pairs that may touch while no bead moves by more than its margin; histories and bonds are
/// kept. No margin is smaller than `least` (m).
void list_pairs(Simulation& simulation, double least = 0.0);

Energies energies(const Simulation& simulation);

/// r_i − r_j of a pair, and its gap δn.
inline Vec3 apart(const Simulation& simulation, const Pair& pair) {
  return simulation.beads.position[pair.i] - simulation.beads.position[pair.j];
}
inline double gap(const Simulation& simulation, const Pair& pair) {
  return apart(simulation, pair).norm() - simulation.beads.radius[pair.i] - simulation.beads.radius[pair.j];
}

/// Breaks a bond: its pair's springs, the bond list, the sums and the list of events.
void break_bond(Simulation& simulation, Pair& pair);

/// Ends a step: books the platens' work, moves them, counts the step.
void advance_platens(Simulation& simulation);

/// Number of standing bonds and of touching pairs, per bead: bonds first, touching second.
struct BeadContacts {
  std::vector<int> bonds, touching;
};
BeadContacts bead_contacts(const Simulation& simulation);

}  // namespace pendular::dem_core
