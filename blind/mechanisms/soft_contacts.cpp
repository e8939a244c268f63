#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void soften(dem_core::Simulation& simulation, double theta) {
  simulation.law.k_glass *= 1.0 - theta;
  simulation.law.kt_glass *= 1.0 - theta;
}

}  // namespace

/// Beads are coated: where they touch, each other or a platen, the contact has lost the share θ of its
/// stiffness. Lowers E.
Mechanism soft_contacts() {
  return {.id = "soft_contacts",
          .kind = "contacts",
          .unit = "fraction",
          .meaning = "stiffness that contacts of beads have lost",
          .from = 0.3,
          .to = 0.7,
          .simulation = soften};
}

}  // namespace pendular::blind
