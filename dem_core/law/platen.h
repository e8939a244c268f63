#pragma once

#include <vector>

#include "dem_core/law/pair.h"

namespace pendular {

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

/// What a platen does to one bead in one step.
struct PlatenForce {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< on the bead
  double normal = 0.0;                               ///< on the platen, N
  double damped = 0.0, slipped = 0.0;                ///< energy lost in the step, J
};

/// Bead k against a platen: the law between beads, without a bond; the platen does not turn. Advances the
/// bead's slip.
inline PlatenForce touch_platen(Platen& platen, std::size_t k, const BeadMotion& bead,
                                const LawParameters& law, double dt) {
  PlatenForce out;
  Vec3& slip = platen.slip[k];
  double& last_closing = platen.closing[k];
  const double gap = platen.gap(k, bead.position.z(), bead.radius);
  if (gap > 0.0 && last_closing == 0.0 && slip.isZero(0.0)) return out;
  const Vec3 n(0.0, 0.0, platen.normal_sign);
  const double arm = bead.radius + 0.5 * gap;
  const Vec3 velocity = bead.velocity - Vec3(0.0, 0.0, platen.velocity);
  const Vec3 surface = velocity - arm * bead.spin.cross(n);
  const double closing = velocity.dot(n), glass = HWY_NAMESPACE::contact_force(gap, 0.0, law.k_glass);
  const double opposed = gap <= 0.0 ? closing : 0.0;
  Triple<double> sliding = triple(slip + (surface - surface.dot(n) * n) * dt);
  out.slipped = HWY_NAMESPACE::limit_slip(triple(slip), sliding, law.kt_glass, law.platen_friction * glass);
  slip = vec3(sliding);
  out.damped = 0.5 * law.damping * dt * last_closing * (last_closing + closing);
  last_closing = opposed;
  const Vec3 tangential = -law.kt_glass * slip;
  out.normal = glass - law.damping * opposed;
  out.force = out.normal * n + tangential;
  out.torque = -arm * n.cross(tangential);
  return out;
}

}  // namespace pendular
