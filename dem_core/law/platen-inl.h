// A bead against a platen in one time step: the law between two beads, without a bond; the platen does not
// turn. Real is double or Lanes (numbers-inl.h).

#if defined(PENDULAR_DEM_CORE_PLATEN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_PLATEN_INL_H
#undef PENDULAR_DEM_CORE_PLATEN_INL_H
#else
#define PENDULAR_DEM_CORE_PLATEN_INL_H
#endif

#include "dem_core/law/laws-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {

/// Advances what a platen remembers of a bead.
template <typename Real>
HWY_INLINE PlatenAction<Real> touch(const PlatenNumbers<Real>& platen, LawParts parts,
                                    const PlatenBead<Real>& bead, PlatenMemory<Real>& memory) {
  const Real zero = same(0.0, bead.z), half = same(0.5, bead.z);
  const Real gap = mul_add(platen.sign, bead.z - platen.z, bead.relief) - bead.radius;
  const Real arm = mul_add(half, gap, bead.radius), signed_arm = platen.sign * arm;
  const Real closing = platen.sign * (bead.velocity.z - platen.velocity);
  const Real glass =
      contact_force(gap, zero, GlassLaw<Real>{platen.k_glass, platen.per_overlap, parts.hertz});
  const Real opposed = select(gap <= zero, closing, zero);

  const Triple<Real> sliding = {neg_mul_add(signed_arm, bead.spin.y, bead.velocity.x),
                                mul_add(signed_arm, bead.spin.x, bead.velocity.y), zero};
  const Triple<Real> before = {memory.slip_x, memory.slip_y, zero};
  Triple<Real> slip = mul_add(platen.dt, sliding, before);
  PlatenAction<Real> out;
  // Once apart the limit is zero: what the spring still held is lost.
  out.slipped = limit_slip(before, slip, platen.kt_glass, platen.friction * glass);
  out.damped = platen.half_damping_dt * (memory.closing * (memory.closing + closing));
  memory = {slip.x, slip.y, opposed};

  out.normal = neg_mul_add(platen.damping, opposed, glass);
  out.force = {-platen.kt_glass * slip.x, -platen.kt_glass * slip.y, platen.sign * out.normal};
  out.torque_x = signed_arm * out.force.y, out.torque_y = -signed_arm * out.force.x;
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
