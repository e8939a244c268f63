#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

void tilt(dem_core::Simulation& simulation, const ActualSpecimen& specimen, double theta,
          const Draws& draws) {
  const double slope = std::tan(theta * M_PI / 180.0), way = 2.0 * M_PI * draws.uniform(0);
  const double along_x = slope * std::cos(way), along_y = slope * std::sin(way);
  const auto& cylinder = specimen.packing.specimen;
  for (std::size_t k = 0; k < simulation.beads.size(); ++k) {
    const Vec3& place = simulation.beads.position[k];
    simulation.top.relief[k] +=
        along_x * (place.x() - cylinder.axis_x) + along_y * (place.y() - cylinder.axis_y);
  }
  dem_core::place_platens(simulation, simulation.bottom.velocity);
  dem_core::list_pairs(simulation);
}

}  // namespace

/// The paper's platens are parallel. A real one may be tilted: the top platen's face rises by θ in one
/// direction, which is drawn. It touches one side first. Lengthens the toe, the more the lower the specimen;
/// lowers E of a short test.
Effect platen_tilt() {
  return {.id = "platen_tilt",
          .unit = "degrees",
          .name = "tilted platen",
          .sentence = "The platens are not parallel, so that one side is loaded first.",
          .meaning = "angle between the platens",
          .lowest = 0.0,
          .highest = 10.0,
          .bank_from = 0.0,
          .bank_to = 2.0,
          .draws = true,
          .simulation = tilt};
}

}  // namespace pendular::effects
