#include "dem_core/drive/relaxation.h"

#include <algorithm>

#include "base/interrupt.h"
#include "dem_core/observe/quasi_static.h"
#include "dem_core/step/forces.h"

namespace pendular::dem_core {
namespace {

constexpr int kTravelSteps = 40;    // long enough for the dashpots' forces to stay below the springs'
constexpr int kLook = 4;            // steps between two looks at the kinetic energy
constexpr int kMostSteps = 40'000;  // some fifty periods of a specimen of 8,000 beads

/// Steps to just after the next maximum of the kinetic energy and halts; false where the user interrupts.
bool swing(Stepper& stepper, int& steps) {
  double highest = 0.0;
  for (double now = 0.0; now >= highest && steps < kMostSteps; now = stepper.kinetic_energy()) {
    highest = now;
    for (int k = 0; k < kLook; ++k, ++steps) stepper.step();
    if (interrupted()) return false;
  }
  stepper.halt();
  return true;
}

}  // namespace

std::optional<Relaxed> compress_and_relax(Simulation& simulation, Stepper& stepper,
                                          const Increment& increment) {
  const double speed = increment.strain * simulation.initial_height / (kTravelSteps * simulation.dt);
  const double bottom = simulation.bottom.z, top = simulation.top.z;
  stepper.set_in_motion(speed, [&](const Vec3& at) {
    return Vec3(0.0, 0.0, speed * std::clamp((top - at.z()) / (top - bottom), 0.0, 1.0));
  });
  for (int k = 0; k < kTravelSteps; ++k) stepper.step();
  stepper.halt();

  auto done = come_to_rest(simulation, stepper, increment.unbalanced);
  if (done) done->steps += kTravelSteps;
  return done;
}

std::optional<Relaxed> come_to_rest(Simulation& simulation, Stepper& stepper, double unbalanced) {
  Relaxed done;
  do {
    if (!swing(stepper, done.steps)) return std::nullopt;
    stepper.store();
    done.unbalanced = unbalanced_force(simulation, forces(simulation));
  } while (done.unbalanced > unbalanced && done.steps < kMostSteps);
  return done;
}

}  // namespace pendular::dem_core
