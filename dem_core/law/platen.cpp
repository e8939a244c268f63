#include "dem_core/law/platen.h"

#include "dem_core/law/laws-inl.h"

namespace pendular::dem_core {

PlatenForce touch_platen(Platen& platen, std::size_t k, const BeadMotion& bead, const LawParameters& law,
                         double dt) {
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

}  // namespace pendular::dem_core
