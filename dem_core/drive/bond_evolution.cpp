#include "dem_core/drive/bond_evolution.h"

#include <algorithm>
#include <cmath>

namespace pendular {

void change_bond(Simulation& simulation, Pair& pair, const BondEvolution& evolution, double elapsed) {
  const Vec3 way = apart(simulation, pair);
  const double radii = simulation.beads.radius[pair.i] + simulation.beads.radius[pair.j];
  const auto energy = [&] { return pair_energy(way, radii, pair.properties, pair.history, simulation.law); };
  const double before = energy();
  evolution.change({std::max(way.norm() - radii, pair.properties.touch) - pair.properties.rest,
                    std::sqrt(dot(pair.history.bond_slip, pair.history.bond_slip)),
                    simulation.bonds[pair.bond].height, elapsed, way / way.norm(), pair.properties,
                    pair.history,
                    simulation.bond_memory.data() + evolution.memory * static_cast<std::size_t>(pair.bond)});
  simulation.work.given += energy() - before;
}

}  // namespace pendular
