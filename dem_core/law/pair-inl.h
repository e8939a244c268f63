// Two beads in one time step: the laws put together. Real is double or Lanes (numbers-inl.h).

#if defined(PENDULAR_DEM_CORE_PAIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_PAIR_INL_H
#undef PENDULAR_DEM_CORE_PAIR_INL_H
#else
#define PENDULAR_DEM_CORE_PAIR_INL_H
#endif

#include "dem_core/law/laws-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {

/// Two beads as a pair sees them; SI.
template <typename Real>
struct PairMotion {
  Triple<Real> apart;     ///< r_i − r_j
  Triple<Real> velocity;  ///< v_i − v_j
  Triple<Real> rolling;   ///< R_i ω_i + R_j ω_j
  Triple<Real> spin;      ///< ω_i + ω_j
  Triple<Real> turning;   ///< ω_i − ω_j; read where the law has bending
  Real radii;             ///< R_i + R_j
};

/// How a pair moves, seen along and across its line of centres.
template <typename Real>
struct PairApproach {
  Triple<Real> n;        ///< from j to i
  Triple<Real> sliding;  ///< velocity of i's surface against j's, normal to n
  Real gap;              ///< δn
  Real closing;          ///< velocity of i against j along n
  Real twist;            ///< mean rotation of both beads about n in the step, rad
};

/// What of two beads' motion the law is about.
///
/// The arms end in mid-gap, not on the surfaces as in the paper's eq. 2: only then does a pair that turns as
/// a rigid body feel no shear, and angular momentum is conserved.
template <typename Real>
HWY_INLINE PairApproach<Real> approach(const PairMotion<Real>& motion, const LawNumbers<Real>& law) {
  PairApproach<Real> pair;
  const Real distance = square_root(dot(motion.apart, motion.apart));
  pair.gap = distance - motion.radii;
  pair.n = (same(1.0, distance) / distance) * motion.apart;
  pair.closing = dot(motion.velocity, pair.n);
  const Real half_gap = same(0.5, distance) * pair.gap;
  const Triple<Real> surface =
      cross_add(pair.n, mul_add(half_gap, motion.spin, motion.rolling), motion.velocity);
  pair.sliding = neg_mul_add(dot(surface, pair.n), pair.n, surface);
  pair.twist = law.half_dt * dot(motion.spin, pair.n);
  return pair;
}

/// Advances a pair's springs by the motion of one time step and returns its force. `may_touch` false: the
/// glass of these pairs is known to be apart. `motion` is read where the law has bending.
template <bool may_touch, typename Real>
HWY_INLINE PairAction<Real> advance_pair(const PairApproach<Real>& seen, const PairMotion<Real>& motion,
                                         const PairData<Real>& pair, const LawNumbers<Real>& law,
                                         LawParts parts, PairMemory<Real>& memory) {
  const auto& [n, sliding, gap, closing, spin] = seen;
  const Real zero = same(0.0, gap);
  const Triple<Real> nowhere = {zero, zero, zero};
  const auto bonded = pair.kn > zero;
  const auto touching = gap <= pair.touch;

  PairAction<Real> out;
  Real normal = bond_force(gap, pair, parts.hertz);
  const GlassLaw<Real> glass_law = {law.k_glass, law.per_overlap, parts.hertz};
  Triple<Real> tangential = nowhere;
  out.slipped = zero;
  if (parts.one_spring) {
    const Real glass = contact_force(gap, pair.touch, glass_law);
    normal = normal + glass;
    const Triple<Real> before = memory.bond_slip;
    Triple<Real> slip = mul_add(law.dt, sliding, carried(before, n, spin));
    const Real k = select(touching, law.kt_glass, pair.kt);
    const Real limit = law.friction * magnitude(normal);
    if (parts.bond_friction_limit) {
      out.slipped = limit_slip(before, slip, k, limit);
    } else {
      const Real no_limit = same(1e300, gap);
      out.slipped = limit_slip(before, slip, select(touching, k, zero), select(touching, limit, no_limit));
    }
    memory.bond_slip = select(either(bonded, touching), slip, nowhere);
    tangential = -k * memory.bond_slip;
  } else {
    const Triple<Real> before = memory.bond_slip;
    Triple<Real> slip = mul_add(law.dt, sliding, carried(before, n, spin));
    if (parts.bond_friction_limit)
      out.slipped = limit_slip(before, slip, pair.kt, law.friction * magnitude(normal));
    memory.bond_slip = select(bonded, slip, nowhere);
    tangential = -pair.kt * memory.bond_slip;
    if (may_touch) {
      const Triple<Real> last = memory.contact_slip;
      const Real glass = contact_force(gap, pair.touch, glass_law);
      normal = normal + glass;
      Triple<Real> slip_now = mul_add(law.dt, sliding, carried(last, n, spin));
      // Once apart the limit is zero: what the spring still held is lost.
      out.slipped = out.slipped + limit_slip(last, slip_now, law.kt_glass, law.friction * glass);
      memory.contact_slip = slip_now;
      tangential = neg_mul_add(law.kt_glass, slip_now, tangential);
    }
  }

  const auto acting = may_touch ? either(bonded, touching) : bonded;
  const Real opposed = select(acting, closing, zero);
  out.damped = law.half_damping_dt * (memory.closing * (memory.closing + closing));
  memory.closing = opposed;
  out.force = mul_add(neg_mul_add(law.damping, opposed, normal), n, tangential);
  out.couple = cross(n, tangential);
  out.moment = nowhere;
  if (parts.bending) {
    // Carried along by the mean rotation of both beads.
    const Triple<Real> with_pair = cross_add(law.half_dt * motion.spin, memory.turn, memory.turn);
    const Triple<Real> turn = mul_add(law.dt, motion.turning, with_pair);
    memory.turn = select(bonded, turn, nowhere);
    out.moment = bending_moment(memory.turn, n, pair);
  }
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
