#include <cmath>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

constexpr double kHalfThickness = 1.5;  // bead diameters

void soften(dem_core::Simulation& simulation, double theta) {
  const auto& at = simulation.beads.position;
  const double middle = 0.5 * (simulation.bottom.z + simulation.top.z);
  const double reach = kHalfThickness * simulation.beads.mean_diameter();
  for (auto& pair : simulation.pairs) {
    if (pair.bond < 0 || std::fabs(0.5 * (at[pair.i].z() + at[pair.j].z()) - middle) > reach) continue;
    pair.properties.kn *= 1.0 - theta;
    pair.properties.kt *= 1.0 - theta;
  }
}

}  // namespace

/// Polymer that did not cure at mid-height: in a layer three beads thick bridges have lost the share θ of
/// their stiffness. Lowers E, the more the lower the specimen.
Mechanism weak_layer() {
  return {.id = "weak_layer",
          .kind = "specimen",
          .unit = "fraction",
          .meaning = "stiffness that the bridges of a layer at mid-height have lost",
          .from = 0.3,
          .to = 0.7,
          .simulation = soften};
}

}  // namespace pendular::blind
