#include "base/error.h"
#include "dem_core/drive/relaxation.h"
#include "effects/effect.h"

namespace pendular::effects {
namespace {

/// Away from the platens, until the forces balance.
void settle(dem_core::Simulation& simulation, double unbalanced) {
  const double away = simulation.beads.mean_diameter();
  simulation.bottom.z -= away, simulation.top.z += away;
  simulation.bottom.velocity = 0.0;
  dem_core::list_pairs(simulation);
  dem_core::Stepper stepper(simulation);
  if (!dem_core::come_to_rest(simulation, stepper, unbalanced))
    throw Interrupted("interrupted while the specimen settles under its residual stress");
}

void shrink(dem_core::Simulation& simulation, const ActualSpecimen& specimen, double theta, const Draws&) {
  for (auto& pair : simulation.pairs)
    if (pair.bond >= 0)
      pair.properties.rest -= theta * simulation.bonds[static_cast<std::size_t>(pair.bond)].height;
  const double speed = simulation.bottom.velocity;
  settle(simulation, specimen.sample.compression.relax_to);
  // The test begins here.
  simulation.beads.start = simulation.beads.position;
  simulation.steps = 0;
  for (auto& event : simulation.events) event.strain = 0.0;
  simulation.work = {};
  simulation.work.given = dem_core::energies(simulation).elastic;
  dem_core::place_platens(simulation, speed);
  dem_core::list_pairs(simulation);
}

}  // namespace

/// The paper's bonds carry nothing before the test. A real polymer shrinks as it cures: each bond is at rest
/// at a gap shorter by θ of its height, and pulls. The specimen comes to equilibrium under that before the
/// platens touch it. Beads that touch are pressed together; bonds are part of the way to breaking. Raises E
/// where contacts were open. What it does to the peak has not been measured.
Effect residual_stress() {
  return {.id = "residual_stress",
          .unit = "strain",
          .name = "bridges shrunk by curing",
          .sentence = "Bridges shrank as the polymer cured and pull on the beads before the test.",
          .meaning = "shrinkage of the bridges from curing",
          .lowest = -0.05,
          .highest = 0.3,
          .bank_from = 0.0,
          .bank_to = 0.15,
          .simulation = shrink};
}

}  // namespace pendular::effects
