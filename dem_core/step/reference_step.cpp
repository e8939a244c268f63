#include "dem_core/step/reference_step.h"

namespace pendular::dem_core {

void reference_step(Simulation& simulation) {
  auto& beads = simulation.beads;
  const double dt = simulation.dt;
  std::vector<Vec3> force(beads.size(), Vec3::Zero()), torque = force;
  std::vector<Pair*> breaking;
  for (auto& pair : simulation.pairs) {
    const PairForce action = advance_pair(beads.motion(pair.i), beads.motion(pair.j), pair.properties,
                                          simulation.law, dt, pair.history);
    force[pair.i] += vec3(action.force);
    force[pair.j] -= vec3(action.force);
    torque[pair.i] += torque_on_i(action, beads.radius[pair.i]);
    torque[pair.j] += torque_on_j(action, beads.radius[pair.j]);
    simulation.work.damped += action.damped;
    simulation.work.slipped += action.slipped;
    if (breaks(gap(simulation, pair), pair.properties, pair.history, simulation.law))
      breaking.push_back(&pair);
  }
  for (Platen* platen : {&simulation.bottom, &simulation.top}) {
    platen->force = 0.0;
    for (std::size_t k = 0; k < beads.size(); ++k) {
      const PlatenForce action = touch_platen(*platen, k, beads.motion(k), simulation.law, dt);
      force[k] += action.force;
      torque[k] += action.torque;
      platen->force += action.normal;
      simulation.work.damped += action.damped;
      simulation.work.slipped += action.slipped;
    }
  }
  for (std::size_t k = 0; k < beads.size(); ++k) {
    beads.velocity[k] += dt / beads.mass[k] * force[k];
    beads.spin[k] += dt / beads.inertia[k] * torque[k];
    beads.position[k] += dt * beads.velocity[k];
  }
  for (Pair* pair : breaking) break_bond(simulation, *pair);
  advance_platens(simulation);
}

}  // namespace pendular::dem_core
