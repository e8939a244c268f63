#pragma once

namespace pendular::micromechanics {

/// The body of one bridge (paper, Sec. 2.3): a cylinder of diameter d on the line of the centres of two
/// beads, truncated by their caps. Lengths in m.
struct BridgeBody {
  double neck_diameter = 0.0;  ///< d
  double gap = 0.0;            ///< δ0, between the beads' surfaces on the axis
  double diameter_i = 0.0, diameter_j = 0.0;
};

/// Height of the bridge at its rim, m: gap + the sagittas of both caps at radius d/2.
/// l = δ0 + (D_i + D_j)/2 − √(R_i² − d²/4) − √(R_j² − d²/4). Requires d < D_i, D_j.
double rim_height(double gap, double diameter_i, double diameter_j, double neck_diameter);

/// Volume of polymer in the bridge, m³: cylinder of the rim's height minus both caps. Requires d < D_i, D_j.
double bridge_volume(double gap, double diameter_i, double diameter_j, double neck_diameter);

}  // namespace pendular::micromechanics
