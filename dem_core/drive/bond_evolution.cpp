#include "dem_core/drive/bond_evolution.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pendular::dem_core {
namespace {

double energy(const Simulation& simulation, const Pair& pair) {
  const double radii = simulation.beads.radius[pair.i] + simulation.beads.radius[pair.j];
  return pair_energy(apart(simulation, pair), radii, pair.properties, pair.history, simulation.law);
}

BondMoment moment_of(Simulation& simulation, Pair& pair, const BondEvolution& evolution, double elapsed) {
  const Vec3 way = apart(simulation, pair);
  const double radii = simulation.beads.radius[pair.i] + simulation.beads.radius[pair.j];
  return {std::max(way.norm() - radii, pair.properties.touch) - pair.properties.rest,
          length(pair.history.bond_slip),
          simulation.bonds[pair.bond].height,
          elapsed,
          way / way.norm(),
          pair.properties,
          pair.history,
          simulation.bond_memory.data() + evolution.memory * static_cast<std::size_t>(pair.bond)};
}

}  // namespace

void change_bond(Simulation& simulation, Pair& pair, const BondEvolution& evolution, double elapsed) {
  const double before = energy(simulation, pair);
  evolution.change(moment_of(simulation, pair, evolution, elapsed));
  simulation.work.given += energy(simulation, pair) - before;
}

void change_all_bonds(Simulation& simulation, std::span<Pair* const> pairs, const BondEvolution& evolution,
                      double elapsed) {
  std::vector<BondMoment> moments;
  moments.reserve(pairs.size());
  double given = 0.0;
  for (Pair* pair : pairs) {
    given -= energy(simulation, *pair);
    moments.push_back(moment_of(simulation, *pair, evolution, elapsed));
  }
  evolution.change_all(moments);
  for (const Pair* pair : pairs) given += energy(simulation, *pair);
  simulation.work.given += given;
}

}  // namespace pendular::dem_core
