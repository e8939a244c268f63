#pragma once

#include <cmath>

#include "dem_core/drive/bond_evolution.h"

namespace pendular::effects {

/// A bond's stiffness without what it has lost by one effect so far becomes its stiffness without `lost`;
/// shares of 1. Effects that weaken bonds thus multiply. `so_far` remembers the share.
inline void weaken(const dem_core::BondMoment& bond, double lost, double& so_far) {
  const double factor = (1.0 - lost) / (1.0 - so_far);
  for (double* k :
       {&bond.properties.kn, &bond.properties.kt, &bond.properties.k_bend, &bond.properties.k_twist})
    *k *= factor;
  so_far = lost;
}

/// √(Δr_n² + |δt|²/12), the measure of Griffith's criterion, m.
inline double griffith_length(const dem_core::BondMoment& bond) {
  return std::sqrt(bond.stretch * bond.stretch + bond.shear * bond.shear / 12.0);
}

}  // namespace pendular::effects
