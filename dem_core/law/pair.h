#pragma once

#include "base/vec3.h"
#include "dem_core/law/pair-inl.h"

namespace pendular {

using PairHistory = HWY_NAMESPACE::PairMemory<double>;
using HWY_NAMESPACE::Triple;

inline Triple<double> triple(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 vec3(const Triple<double>& t) {
  return {t.x, t.y, t.z};
}

inline LawNumbers<double> numbers(const LawParameters& law, double dt) {
  return {law.k_glass, law.kt_glass, law.friction, law.damping, dt, 0.5 * dt, 0.5 * law.damping * dt};
}
inline LawParts parts(const LawParameters& law) {
  return {law.one_spring, law.bond_friction_limit, law.bending};
}

/// One bead as its pairs see it; SI.
struct BeadMotion {
  Vec3 position, velocity, spin;
  double radius;
};

struct PairForce : HWY_NAMESPACE::PairAction<double> {
  double half_gap;  ///< arm of a bead: its radius + half_gap, so that both meet in mid-gap
};

/// Advances the pair's springs by the motion of one time step and returns its force.
inline PairForce advance_pair(const BeadMotion& i, const BeadMotion& j, const PairProperties& pair,
                              const LawParameters& law, double dt, PairHistory& history) {
  const HWY_NAMESPACE::PairMotion<double> motion = {triple(i.position - j.position),
                                                    triple(i.velocity - j.velocity),
                                                    triple(i.radius * i.spin + j.radius * j.spin),
                                                    triple(i.spin + j.spin),
                                                    triple(i.spin - j.spin),
                                                    i.radius + j.radius};
  const auto seen = HWY_NAMESPACE::approach(motion, numbers(law, dt));
  return {HWY_NAMESPACE::advance_pair<true>(seen, motion, pair, numbers(law, dt), parts(law), history),
          0.5 * seen.gap};
}

/// Torques of a pair's force on its beads, N m.
inline Vec3 torque_on_i(const PairForce& force, double radius_i) {
  return -(radius_i + force.half_gap) * vec3(force.couple) + vec3(force.moment);
}
inline Vec3 torque_on_j(const PairForce& force, double radius_j) {
  return -(radius_j + force.half_gap) * vec3(force.couple) - vec3(force.moment);
}

/// F^n without damping, N; positive pushes apart.
inline double normal_force(double gap, const PairProperties& pair, const LawParameters& law) {
  return HWY_NAMESPACE::contact_force(gap, pair.touch, law.k_glass) + HWY_NAMESPACE::bond_force(gap, pair);
}

inline bool breaks(double gap, const PairProperties& pair, const PairHistory& history) {
  return pair.kn > 0.0 && HWY_NAMESPACE::breaks(gap, history.bond_slip, pair);
}

/// Energy stored in a pair's springs, J; `apart` is r_i − r_j, `radii` the sum of both.
inline double pair_energy(const Vec3& apart, double radii, const PairProperties& pair,
                          const PairHistory& history, const LawParameters& law) {
  const double distance = apart.norm(), gap = distance - radii;
  const double bond_shear = dot(history.bond_slip, history.bond_slip);
  double energy = HWY_NAMESPACE::normal_energy(gap, pair, law.k_glass) +
                  HWY_NAMESPACE::bending_energy(history.turn, triple(apart / distance), pair);
  if (law.one_spring) return energy + 0.5 * (gap <= pair.touch ? law.kt_glass : pair.kt) * bond_shear;
  return energy + 0.5 * pair.kt * bond_shear +
         0.5 * law.kt_glass * dot(history.contact_slip, history.contact_slip);
}

/// Takes the bond from a pair; returns the energy this releases, J. With one spring the displacement of a
/// touching pair stays, as friction.
inline double break_bond(const Vec3& apart, double radii, const LawParameters& law, PairProperties& pair,
                         PairHistory& history) {
  const double before = pair_energy(apart, radii, pair, history, law);
  pair.kn = pair.kt = pair.k_bend = pair.k_twist = 0.0;
  history.turn = {};
  if (!law.one_spring || apart.norm() - radii > pair.touch) history.bond_slip = {};
  return before - pair_energy(apart, radii, pair, history, law);
}

}  // namespace pendular
