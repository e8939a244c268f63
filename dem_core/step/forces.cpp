#include "dem_core/step/forces.h"

#include "base/parallel.h"

namespace pendular::dem_core {
namespace {

/// On a copy of what the platen remembers of each bead.
std::vector<PlatenContact> platen_contacts(const Platen& platen, const Simulation& simulation) {
  const auto& beads = simulation.beads;
  std::vector<PlatenContact> contacts;
  Platen one = {platen.z, platen.velocity, platen.normal_sign, {Vec3::Zero()}, {0.0}, 0.0, {0.0}};
  for (std::size_t k = 0; k < beads.size(); ++k) {
    if (platen.gap(k, beads.position[k].z(), beads.radius[k]) > 0.0) continue;
    one.relief[0] = platen.relief[k];
    one.slip[0] = platen.slip[k];
    one.closing[0] = platen.closing[k];
    contacts.push_back({k, touch_platen(one, 0, beads.motion(k), simulation.law, simulation.dt).force});
  }
  return contacts;
}

}  // namespace

Forces forces(const Simulation& simulation) {
  const BeadStates& beads = simulation.beads;
  Forces out;
  out.bottom = platen_contacts(simulation.bottom, simulation);
  out.top = platen_contacts(simulation.top, simulation);
  const auto& pairs = simulation.pairs;
  out.pair.resize(pairs.size());
  for_blocks(pairs.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      PairHistory advanced = pairs[p].history;
      out.pair[p] = vec3(advance_pair(beads.motion(pairs[p].i), beads.motion(pairs[p].j), pairs[p].properties,
                                      simulation.law, simulation.dt, advanced)
                             .force);
    }
  });
  out.net.assign(beads.size(), Vec3::Zero());
  for (const auto* platen : {&out.bottom, &out.top})
    for (const auto& contact : *platen) out.net[contact.bead] += contact.force;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    out.net[pairs[p].i] += out.pair[p];
    out.net[pairs[p].j] -= out.pair[p];
  }
  return out;
}

}  // namespace pendular::dem_core
