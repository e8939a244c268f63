#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec3.h"

namespace pendular {

/// The laws between two beads (Hemmerle et al. 2021, Sec. 3.2.2), as functions of plain numbers. SI units.
/// Conventions: n points from bead j to bead i; `gap` is the surface separation δn; a normal force is
/// positive where it pushes the beads apart.

/// What one pair has of its own. A pair without a standing bond has kn = kt = 0.
struct PairProperties {
  double rest = 0.0;  ///< δ0: initial gap of the pair, m
  double touch =
      0.0;  ///< gap at which the glass touches: 0, or the initial overlap where measured diameters overlap
  double kn = 0.0, kt = 0.0;  ///< bond stiffness, N/m
  double break_limit = 0.0;   ///< 2 G l / E_p, m²
};

/// The same for all pairs of a specimen.
struct LawParameters {
  double k_glass = 0.0, kt_glass = 0.0;  ///< contact stiffness, N/m
  double friction = 0.0;                 ///< μ
  double platen_friction = 0.0;
  double damping = 0.0;             ///< ζ, N s/m
  bool one_spring = false;          ///< one tangential spring whose stiffness changes at touch
  bool bond_friction_limit = true;  ///< Coulomb limit on the bond's tangential force too
};

/// Glass part of the normal force: −k_glass (δn − touch) in overlap.
inline double contact_force(double gap, double touch, double k_glass) {
  return gap <= touch ? -k_glass * (gap - touch) : 0.0;
}

/// Bond part of the normal force: −kn (δn − δ0) apart, constant in overlap (paper, eq. 3).
inline double bond_force(double gap, const PairProperties& pair) {
  return -pair.kn * (std::max(gap, pair.touch) - pair.rest);
}

/// Energy of which contact_force + bond_force is minus the derivative with respect to the gap, J.
inline double normal_energy(double gap, const PairProperties& pair, double k_glass) {
  const double stretch = std::max(gap, pair.touch) - pair.rest;
  const double bond = 0.5 * pair.kn * stretch * stretch;
  if (gap > pair.touch) return bond;
  const double overlap = pair.touch - gap;
  return bond + 0.5 * k_glass * overlap * overlap - pair.kn * stretch * overlap;
}

/// A tangential displacement carried along with the contact plane: projected on the plane normal to n with
/// its length kept, and turned about n by `spin` (the mean rotation of both beads about n in the step, rad).
inline Vec3 carried(const Vec3& slip, const Vec3& n, double spin) {
  const double before = slip.squaredNorm();
  if (before == 0.0) return slip;
  Vec3 flat = slip - n.dot(slip) * n;
  const double after = flat.squaredNorm();
  if (after > 0.0) flat *= std::sqrt(before / after);
  return flat + spin * n.cross(flat);
}

/// Coulomb's law on a spring of stiffness k: shortens `slip` so that k|slip| ≤ limit. Returns the energy
/// lost, J.
inline double limit_slip(Vec3& slip, double k, double limit) {
  const double squared = slip.squaredNorm();
  if (k * k * squared <= limit * limit) return 0.0;
  const double length = std::sqrt(squared), kept = limit / k;
  slip *= kept / length;
  return 0.5 * k * (squared - kept * kept);
}

/// Griffith's criterion (paper, eq. 4): Δr_n² + |δt|²/12 ≥ 2 G l / E_p.
inline bool breaks(double gap, const Vec3& bond_slip, const PairProperties& pair) {
  const double stretch = gap - pair.rest;
  return stretch * stretch + bond_slip.squaredNorm() / 12.0 >= pair.break_limit;
}

}  // namespace pendular
