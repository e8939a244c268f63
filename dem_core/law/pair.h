#pragma once

#include <cmath>

#include "base/vec3.h"
#include "dem_core/law/law_parameters.h"

namespace pendular::dem_core {

inline Triple<double> triple(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 vec3(const Triple<double>& t) {
  return {t.x, t.y, t.z};
}

inline double length(const Triple<double>& t) {
  return std::sqrt(t.x * t.x + (t.y * t.y + t.z * t.z));
}

inline double per_overlap(const LawParameters& law) {
  return law.hertz_overlap > 0.0 ? 1.0 / law.hertz_overlap : 0.0;
}
inline LawNumbers<double> numbers(const LawParameters& law, double dt) {
  return {law.k_glass, law.kt_glass, per_overlap(law), law.friction,
          law.damping, dt,           0.5 * dt,         0.5 * law.damping * dt};
}
inline LawParts parts(const LawParameters& law) {
  return {law.one_spring, law.bond_friction_limit, law.bending, law.hertz_overlap > 0.0, law.separate_limits};
}

/// One bead as its pairs see it; SI.
struct BeadMotion {
  Vec3 position, velocity, spin;
  double radius;
};

struct PairForce : PairAction<double> {
  double half_gap;  ///< arm of a bead: its radius + half_gap, so that both meet in mid-gap
};

/// Advances the pair's springs by the motion of one time step and returns its force.
PairForce advance_pair(const BeadMotion& i, const BeadMotion& j, const PairProperties& pair,
                       const LawParameters& law, double dt, PairHistory& history);

/// Torques of a pair's force on its beads, N m.
inline Vec3 torque_on_i(const PairForce& force, double radius_i) {
  return -(radius_i + force.half_gap) * vec3(force.couple) + vec3(force.moment);
}
inline Vec3 torque_on_j(const PairForce& force, double radius_j) {
  return -(radius_j + force.half_gap) * vec3(force.couple) - vec3(force.moment);
}

/// Glass part of F^n without damping, N; positive pushes apart. `touch` is the gap at which the glass
/// touches, m.
double contact_force(double gap, double touch, const LawParameters& law);

/// Energy stored in the glass, J.
double contact_energy(double gap, double touch, const LawParameters& law);

/// F^n without damping, N; positive pushes apart.
double normal_force(double gap, const PairProperties& pair, const LawParameters& law);

/// By how much that force falls as the gap of touching glass grows, N/m.
double normal_stiffness(double gap, const PairProperties& pair, const LawParameters& law);

/// Whether a standing bond breaks.
bool breaks(double gap, const PairProperties& pair, const PairHistory& history, const LawParameters& law);

/// Energy stored in a pair's springs, J; `apart` is r_i − r_j, `radii` the sum of both.
double pair_energy(const Vec3& apart, double radii, const PairProperties& pair, const PairHistory& history,
                   const LawParameters& law);

/// Takes the bond from a pair; returns the energy this releases, J. With one spring the displacement of a
/// touching pair stays, as friction.
double break_bond(const Vec3& apart, double radii, const LawParameters& law, PairProperties& pair,
                  PairHistory& history);

}  // namespace pendular::dem_core
