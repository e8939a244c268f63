// The laws between two beads (Hemmerle et al. 2021, Sec. 3.2.2), as functions of plain numbers. SI units.
// Conventions: n points from bead j to bead i; `gap` is the surface separation δn; a normal force is positive
// where it pushes the beads apart. Real is double or Lanes (numbers-inl.h).

#if defined(PENDULAR_DEM_CORE_LAWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_LAWS_INL_H
#undef PENDULAR_DEM_CORE_LAWS_INL_H
#else
#define PENDULAR_DEM_CORE_LAWS_INL_H
#endif

#include "dem_core/law/law_parameters.h"
#include "dem_core/law/numbers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {

/// Force over overlap of glass: k_glass, or as the root of the overlap (Hertz 1881).
template <typename Real>
HWY_INLINE Real glass_secant(Real overlap, const GlassLaw<Real>& glass) {
  return glass.hertz ? glass.k * square_root(glass.per_overlap * overlap) : glass.k;
}

/// Glass part of the normal force: −k_glass (δn − touch) in overlap, or Hertz's.
template <typename Real>
HWY_INLINE Real contact_force(Real gap, Real touch, const GlassLaw<Real>& glass) {
  const Real overlap = larger(touch - gap, same(0.0, gap));
  return glass_secant(overlap, glass) * overlap;
}

/// The gap that a bond feels: in overlap that at touch (paper, eq. 3), unless glass is after Hertz, which at
/// touch has no stiffness of its own.
template <typename Real>
HWY_INLINE Real felt_by_bond(Real gap, Real touch, bool hertz) {
  return hertz ? gap : larger(gap, touch);
}

/// Bond part of the normal force: −kn (δn − δ0).
template <typename Real>
HWY_INLINE Real bond_force(Real gap, const PairData<Real>& pair, bool hertz) {
  return pair.kn * (pair.rest - felt_by_bond(gap, pair.touch, hertz));
}

/// Energy of which contact_force is minus the derivative with respect to the gap, J.
template <typename Real>
HWY_INLINE Real contact_energy(Real gap, Real touch, const GlassLaw<Real>& glass) {
  const Real overlap = larger(touch - gap, same(0.0, gap));
  return same(glass.hertz ? 0.4 : 0.5, gap) * glass_secant(overlap, glass) * overlap * overlap;
}

/// Energy of which bond_force is minus the derivative with respect to the gap, J.
template <typename Real>
HWY_INLINE Real bond_energy(Real gap, const PairData<Real>& pair, bool hertz) {
  const Real felt = felt_by_bond(gap, pair.touch, hertz), stretch = felt - pair.rest;
  return pair.kn * stretch * (same(0.5, gap) * stretch - (felt - gap));
}

/// A tangential displacement carried along with the contact plane: projected on the plane normal to n, and
/// turned about n by `spin` (the mean rotation of both beads about n in the step, rad). Projecting shortens
/// it by half the square of the angle turned in the step, some 1e-10 of its length.
template <typename Real>
HWY_INLINE Triple<Real> carried(const Triple<Real>& slip, const Triple<Real>& n, Real spin) {
  const Triple<Real> flat = neg_mul_add(dot(n, slip), n, slip);
  return cross_add(spin * n, flat, flat);
}

/// Coulomb's law on a spring of stiffness k: shortens `slip` so that k|slip| ≤ limit. Returns the work lost
/// in the step that took the spring from `before` to `slip`, J: the mean of its force before and after times
/// what slid, as the leapfrog scheme does work.
template <typename Real>
HWY_INLINE Real limit_slip(const Triple<Real>& before, Triple<Real>& slip, Real k, Real limit) {
  const Real squared = dot(slip, slip);
  const auto over = k * k * squared > limit * limit;
  const Real share = select(over, limit / (k * square_root(squared)), same(1.0, k));
  const Triple<Real> kept = share * slip;
  const Real lost = same(0.5, k) * k * dot(before + kept, slip - kept);
  slip = kept;
  return lost;
}

/// Griffith's criterion (paper, eq. 4): Δr_n² + |δt|²/12 ≥ 2 G l / E_p. With separate limits one of both
/// terms alone, the first in tension only.
template <typename Real>
HWY_INLINE auto breaks(Real gap, const Triple<Real>& bond_slip, const PairData<Real>& pair,
                       bool separate_limits) {
  const Real stretch = gap - pair.rest, shear = same(1.0 / 12.0, gap) * dot(bond_slip, bond_slip);
  if (!separate_limits) return mul_add(stretch, stretch, shear) >= pair.break_limit;
  const Real tension = larger(stretch, same(0.0, gap));
  return larger(tension * tension, shear) >= pair.break_limit;
}

/// Moment of a bent and twisted bond on bead i; `turn` is the rotation of i against j since the start, rad.
template <typename Real>
HWY_INLINE Triple<Real> bending_moment(const Triple<Real>& turn, const Triple<Real>& n,
                                       const PairData<Real>& pair) {
  const Triple<Real> twist = dot(turn, n) * n;
  return -pair.k_bend * (turn - twist) - pair.k_twist * twist;
}

/// Its energy, J.
template <typename Real>
HWY_INLINE Real bending_energy(const Triple<Real>& turn, const Triple<Real>& n, const PairData<Real>& pair) {
  const Real twist = dot(turn, n);
  return same(0.5, twist) * (pair.k_bend * (dot(turn, turn) - twist * twist) + pair.k_twist * twist * twist);
}

}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
