#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

std::function<void(const dem_core::BondMoment&)> soften(double theta) {
  return [theta](const dem_core::BondMoment& bond) {
    double& lost = bond.memory[0];
    const double now = bond.stretch > 0.0 ? theta : 0.0;
    bond.properties.kn *= (1.0 - now) / (1.0 - lost);
    lost = now;
  };
}

}  // namespace

/// A bridge that is pulled has cavities, which close when it is pressed: in tension its normal stiffness is
/// less by the share θ. Lowers E and restrains the specimen's sides less.
Mechanism tension_softness() {
  return {.id = "tension_softness",
          .kind = "polymer",
          .unit = "fraction",
          .meaning = "normal stiffness that a bridge loses in tension",
          .from = 0.3,
          .to = 0.7,
          .evolution = soften,
          .memory = 1};
}

}  // namespace pendular::blind
