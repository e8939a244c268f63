#pragma once

#include <vector>

#include "dem_core/law/pair.h"

namespace pendular::dem_core {

/// One platen: a rigid wall that only touches, horizontal but for its relief.
struct Platen {
  double z = 0.0;               ///< of the face, m
  double velocity = 0.0;        ///< along z, m/s
  double normal_sign = 1.0;     ///< +1: beads are above it; −1: below
  std::vector<Vec3> slip;       ///< tangential displacement per bead since touch, m
  std::vector<double> closing;  ///< per bead, the speed that damping opposed in the last step, m/s
  double force = 0.0;           ///< on the platen, compression positive, N, in the last step
  /// Per bead, by how much the face lies back where the bead is, m. It pushes along z all the same: what is
  /// left out of a slope is small of second order, and friction holds what is of first.
  std::vector<double> relief;

  /// Between the face and bead k whose centre is at height z, m.
  double gap(std::size_t k, double z_of_bead, double radius) const {
    return normal_sign * (z_of_bead - z) + relief[k] - radius;
  }
};

PlatenNumbers<double> platen_numbers(const Platen& platen, const LawParameters& law, double dt);

/// What a platen does to one bead in one step.
struct PlatenForce {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< on the bead
  double normal = 0.0;                               ///< on the platen, N
  double damped = 0.0, slipped = 0.0;                ///< energy lost in the step, J
};

/// Bead k against a platen: the law between beads, without a bond; the platen does not turn. Advances the
/// bead's slip.
PlatenForce touch_platen(Platen& platen, std::size_t k, const BeadMotion& bead, const LawParameters& law,
                         double dt);

}  // namespace pendular::dem_core
