#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

void roughen(dem_core::Simulation& simulation, const ActualSpecimen&, double theta, const Draws& draws) {
  std::uint64_t counter = 0;
  for (dem_core::Platen* platen : {&simulation.bottom, &simulation.top})
    for (double& relief : platen->relief) relief += 1e-6 * theta * std::fabs(draws.normal(counter++));
  dem_core::place_platens(simulation, simulation.bottom.velocity);
  dem_core::list_pairs(simulation);
}

}  // namespace

/// The paper's platens are plane. Real ones, or the specimen's ends, are uneven on the scale of a bead: where
/// a bead stands the face lies back by |N(0, θ)|. Fewer beads touch at first. Lengthens the toe; lowers E of
/// a short test.
Effect platen_roughness() {
  return {.id = "platen_roughness",
          .unit = "um",
          .name = "rough platens or uneven ends",
          .sentence = "Platens or ends are uneven from bead to bead, so that few beads carry load at first.",
          .meaning = "root mean square of the platens' unevenness from bead to bead",
          .lowest = 0.0,
          .highest = 200.0,
          .bank_from = 0.0,
          .bank_to = 40.0,
          .of_the_ends = true,
          .draws = true,
          .simulation = roughen};
}

}  // namespace pendular::effects
