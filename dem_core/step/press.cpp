#include "dem_core/step/press.h"

namespace pendular::dem_core {

Pressed press(Simulation& simulation, std::size_t bead, const BeadMotion& motion, NearPlatens near,
              const PerQuantum& per) {
  Pressed sum;
  const auto add_of = [&](Platen& platen, std::int64_t& on_platen) {
    const PlatenForce action = touch_platen(platen, bead, motion, simulation.law, simulation.dt);
    for (int axis = 0; axis < 3; ++axis) {
      sum.force[axis] += in_quanta(action.force[axis], per.force);
      sum.torque[axis] += in_quanta(action.torque[axis], per.torque);
    }
    on_platen = in_quanta(action.normal, per.force);
    sum.damped += in_quanta(action.damped, per.energy);
    sum.slipped += in_quanta(action.slipped, per.energy);
  };
  if (near.bottom) add_of(simulation.bottom, sum.bottom);
  if (near.top) add_of(simulation.top, sum.top);
  return sum;
}

}  // namespace pendular::dem_core
