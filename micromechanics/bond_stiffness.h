#pragma once

namespace pendular::micromechanics {

/// Stiffness of one bond between two beads.
struct BondStiffness {
  double normal = 0.0;      ///< kn, N/m
  double tangential = 0.0;  ///< kt, N/m: one bead moved across the bond without rotation
  double bending = 0.0;  ///< N m/rad: beads turned against each other about a transverse axis through mid-gap
  double twisting = 0.0;  ///< N m/rad: about the bond's axis
};

}  // namespace pendular::micromechanics
