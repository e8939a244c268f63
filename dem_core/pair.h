#pragma once

#include "dem_core/laws.h"

namespace pendular {

/// Two beads as a pair sees them; SI.
struct PairMotion {
  Vec3 apart;           ///< r_i − r_j
  Vec3 velocity;        ///< v_i − v_j
  Vec3 spin_i, spin_j;  ///< angular velocities
  double radius_i, radius_j;
};

/// What a pair remembers between steps.
struct PairHistory {
  Vec3 bond_slip = Vec3::Zero();  ///< δt since the start, of the bond (and of the contact, with one spring)
  Vec3 contact_slip = Vec3::Zero();  ///< δt since touch, of the contact
};

/// What a pair does in one step.
struct PairForce {
  Vec3 force = Vec3::Zero();   ///< on bead i; minus this on bead j
  Vec3 couple = Vec3::Zero();  ///< n × F^t; the torque on either bead is minus its arm times this
  double half_gap = 0.0;       ///< arm of a bead: its radius + half_gap, so that both meet in mid-gap
  double normal = 0.0;         ///< F^n without damping, N
  double damped = 0.0;         ///< energy lost to damping in the step, J
  double slipped = 0.0;        ///< energy lost to sliding in the step, J
  bool touching = false;
  bool breaks = false;
};

/// Advances the pair's tangential springs by the motion of one time step and returns its force.
///
/// The arms end in mid-gap, not on the surfaces as in the paper's eq. 2: only then does a pair that turns as
/// a rigid body feel no shear, and angular momentum is conserved.
inline PairForce advance_pair(const PairMotion& motion, const PairProperties& pair, const LawParameters& law,
                              double dt, PairHistory& history) {
  PairForce out;
  const double distance = motion.apart.norm();
  const double gap = distance - (motion.radius_i + motion.radius_j);
  const bool bonded = pair.kn > 0.0;
  out.touching = gap <= pair.touch;
  if (!bonded && !out.touching) {
    history = {};
    return out;
  }
  const Vec3 n = motion.apart / distance;
  out.half_gap = 0.5 * gap;
  const double arm_i = motion.radius_i + out.half_gap, arm_j = motion.radius_j + out.half_gap;
  const double closing = motion.velocity.dot(n);
  const Vec3 surface = motion.velocity - (arm_i * motion.spin_i + arm_j * motion.spin_j).cross(n);
  const Vec3 step = (surface - surface.dot(n) * n) * dt;
  const double spin = 0.5 * (motion.spin_i + motion.spin_j).dot(n) * dt;

  const double glass = contact_force(gap, pair.touch, law.k_glass);
  const double bond = bonded ? bond_force(gap, pair) : 0.0;
  out.normal = glass + bond;
  Vec3 tangential = Vec3::Zero();
  if (law.one_spring) {
    history.bond_slip = carried(history.bond_slip, n, spin) + step;
    const double k = out.touching ? law.kt_glass : pair.kt;
    if (out.touching || law.bond_friction_limit)
      out.slipped = limit_slip(history.bond_slip, k, law.friction * std::fabs(out.normal));
    tangential = -k * history.bond_slip;
  } else {
    if (bonded) {
      history.bond_slip = carried(history.bond_slip, n, spin) + step;
      if (law.bond_friction_limit)
        out.slipped += limit_slip(history.bond_slip, pair.kt, law.friction * std::fabs(bond));
      tangential -= pair.kt * history.bond_slip;
    }
    if (out.touching) {
      history.contact_slip = carried(history.contact_slip, n, spin) + step;
      out.slipped += limit_slip(history.contact_slip, law.kt_glass, law.friction * glass);
      tangential -= law.kt_glass * history.contact_slip;
    } else {
      history.contact_slip.setZero();
    }
  }
  out.damped = law.damping * closing * closing * dt;
  out.force = (out.normal - law.damping * closing) * n + tangential;
  out.couple = n.cross(tangential);
  out.breaks = bonded && breaks(gap, history.bond_slip, pair);
  return out;
}

/// Energy stored in a pair's springs, J.
inline double pair_energy(double gap, const PairProperties& pair, const PairHistory& history,
                          const LawParameters& law) {
  const bool touching = gap <= pair.touch;
  double energy = normal_energy(gap, pair, law.k_glass);
  if (law.one_spring)
    return energy + 0.5 * (touching ? law.kt_glass : pair.kt) * history.bond_slip.squaredNorm();
  energy += 0.5 * pair.kt * history.bond_slip.squaredNorm();
  if (touching) energy += 0.5 * law.kt_glass * history.contact_slip.squaredNorm();
  return energy;
}

/// Takes the bond from a pair; returns the energy this releases, J. With one spring the displacement of a
/// touching pair stays, as friction.
inline double break_bond(double gap, const LawParameters& law, PairProperties& pair, PairHistory& history) {
  const double before = pair_energy(gap, pair, history, law);
  pair.kn = pair.kt = 0.0;
  if (!law.one_spring || gap > pair.touch) history.bond_slip.setZero();
  return before - pair_energy(gap, pair, history, law);
}

}  // namespace pendular
