#pragma once

#include "micromechanics/bond_stiffness.h"
#include "micromechanics/bridge_body.h"
#include "micromechanics/bridge_grid.h"

namespace pendular::micromechanics {

/// Linear elastic, isotropic.
struct Polymer {
  double youngs_modulus = 0.0;  ///< E, Pa
  double poisson_ratio = 0.0;   ///< ν, at least 0 and below 0.5
};

/// Stress in a bridge whose beads move apart along the axis, per metre of that: Pa/m. "Mean" stress is a
/// third of the trace (tension positive), "axial" is σ_zz; the middle is the surface half way between both
/// caps. Nothing is said of the caps' rims, where linear elasticity has no finite stress. Averages are within
/// 0.01 % of converged in the verified range; at ν = 0.499 values in points are within 4 % on the axis, and
/// on the free side within 2 % of the average (docs/bridge.md).
struct BridgeStress {
  double mean_average = 0.0, axial_average = 0.0;  ///< over the volume
  double mean_centre = 0.0, axial_centre = 0.0;    ///< in the middle, on the axis
  double mean_rim = 0.0, axial_rim = 0.0;          ///< in the middle, on the free side
  double mean_greatest = 0.0;                      ///< in the middle, wherever it is greatest
};

/// Stiffness of one bridge. A motion x of one kind stores the energy k x²/2.
struct BridgeStiffness : BondStiffness {
  /// N/rad: transverse force per turn, and moment about mid-gap per transverse displacement, of bead j
  /// against bead i. Zero for equal beads; for others the four are those of one motion without the other.
  double coupling = 0.0;
  double error_estimate = 0.0;  ///< relative, of the four the worst
  BridgeStress stress;
};

/// BadInput for what is no bridge: expects 0 < d < D_i, D_j, δ0 > 0, E > 0, 0 ≤ ν < 0.5, all finite. Bridges
/// of touching beads (δ0 = 0) have no finite normal stiffness.
void check_bridge(const BridgeBody& body, const Polymer& polymer);

/// Whether the accuracy of bridge_stiffness() has been shown there: d over the smaller D from 0.1 to 0.8, δ0
/// over it from 0.001 to 0.1, D_i/D_j from 0.8 to 1.25, ν up to 0.499.
bool within_verified_range(const BridgeBody& body, const Polymer& polymer);

/// Stiffness of a bridge by finite elements: linear elasticity on the exact body, no slip on rigid caps, free
/// side (Hemmerle et al. 2021, Sec. 2.3). Fourier harmonics around the axis; displacement elements of high
/// order on a graded grid, so that near incompressibility does not lock; the stiffness is the energy of the
/// caps' motion, after elimination of all else. Within 0.1 % of converged in the verified range.
/// The error estimate is the difference from a solution on a grid of one order and one rim layer less; the
/// energies fall towards the exact ones, and the error has been found below the estimate in every case tried
/// (docs/bridge.md). BadInput as check_bridge().
BridgeStiffness bridge_stiffness(const BridgeBody& body, const Polymer& polymer);

/// The four alone, on a given grid, without an estimate of the error: what bridge_stiffness() is checked
/// with, and tables are built from.
BondStiffness bridge_stiffness_on(const BridgeBody& body, const Polymer& polymer,
                                  const BridgeResolution& resolution);

}  // namespace pendular::micromechanics
