#pragma once

#include <optional>
#include <vector>

#include "dem_core/observe/curve.h"
#include "dem_core/step/forces.h"

namespace pendular::dem_core {

/// Above these a run counts as dynamic: its stress holds inertia, not only what the specimen resists.
constexpr double kQuasiStaticInertialNumber = 1e-3;  // GDR MiDi 2004, Eur. Phys. J. E 14, 341
constexpr double kQuasiStaticUnbalancedForce = 0.05;

/// I = ε̇ D √(ρ/p): the time D √(ρ/p) in which pressure p moves a bead by its diameter, over the time 1/ε̇ in
/// which the strain grows by one (GDR MiDi 2004). `rate` in 1/s, `diameter` the mean one in m, `density` of
/// the beads in kg/m³, `stress` the current axial stress in Pa. Infinite without load.
double inertial_number(double rate, double diameter, double density, double stress);

/// Mean net force on a bead over the mean force of the pairs that are bonded or touch and of the beads at the
/// platens (Yade's unbalancedForce). Zero where no force acts.
double unbalanced_force(const Simulation& simulation, const Forces& forces);

/// The largest of both over the rows of the curve's linear part, unloading and reloading left out.
struct QuasiStatic {
  double inertial_number = 0.0, unbalanced_force = 0.0;
  bool holds() const {
    return inertial_number <= kQuasiStaticInertialNumber && unbalanced_force <= kQuasiStaticUnbalancedForce;
  }
};

/// Nothing where the curve has no linear part.
std::optional<QuasiStatic> quasi_static(const std::vector<CurveRow>& rows);

}  // namespace pendular::dem_core
