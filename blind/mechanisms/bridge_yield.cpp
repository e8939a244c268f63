#include <cmath>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

constexpr double kYieldStrain = 0.1;  // of a bridge

std::function<void(const dem_core::BondMoment&)> flow(double theta) {
  return [theta](const dem_core::BondMoment& bond) {
    double& flowed = bond.memory[0];
    const double stretch = bond.stretch + flowed;
    const double beyond = std::fabs(stretch) - kYieldStrain * bond.height;
    if (beyond <= 0.0) return;
    const double wanted = std::copysign(theta * beyond, stretch);
    if (wanted * flowed >= 0.0 && std::fabs(wanted) <= std::fabs(flowed)) return;
    bond.properties.rest += wanted - flowed;
    flowed = wanted;
  };
}

}  // namespace

/// The polymer flows: of a bridge's stretch beyond a tenth of its height the share θ is permanent, in tension
/// and in compression. Lowers the slope beyond small strains; the specimen stays short when it is unloaded.
Mechanism bridge_yield() {
  return {.id = "bridge_yield",
          .kind = "polymer",
          .unit = "fraction",
          .meaning = "permanent share of a bridge's strain beyond 0.1",
          .from = 0.5,
          .to = 0.9,
          .evolution = flow,
          .memory = 1};
}

}  // namespace pendular::blind
