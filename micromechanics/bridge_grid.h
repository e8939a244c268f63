#pragma once

#include <Eigen/Dense>

#include "micromechanics/bridge_body.h"

namespace pendular::micromechanics {

/// How finely a bridge is divided. The defaults give the accuracy stated at bridge_stiffness().
struct BridgeResolution {
  int order = 5;             ///< polynomial order of the elements, along both sides; at least 2
  int rim_layers = 3;        ///< elements that shrink geometrically towards the rim of a cap
  double rim_ratio = 0.15;   ///< of the distances of neighbouring layers from the rim
  double rim_reach = 1.25;   ///< width of the zone of layers over half the height at the rim
  double axis_stride = 0.8;  ///< size of radial elements inside, as a step of asinh(r/√(Rδ0))
};

/// A bridge's meridian section cut into quadrilaterals, radial × axial. A point has the coordinates r and η
/// in [0, 1], with z = lower(r) + η (upper(r) − lower(r)). Lengths are over the neck's radius; z = 0 is
/// mid-gap.
struct BridgeGrid {
  int order = 0;
  bool half = false;  ///< the body is symmetric and only z > 0 is taken
  double gap = 0.0;
  double radius_lower = 0.0, radius_upper = 0.0;  ///< of the beads
  Eigen::VectorXd radial, axial;                  ///< bounds of the elements: r from 0 to 1, η from 0 to 1

  struct Section {
    double lower, upper, lower_slope, upper_slope;
  };
  Section section(double r) const;
};

/// The grid of a body, bead i below. Equal beads: half a body.
/// Radial elements grow with the distance from the axis, in proportion to √(Rδ0 + r²): √(Rδ0), with
/// R = D_i D_j/(D_i + D_j), is the radius at which the height has doubled. Near the rim they shrink
/// geometrically, and so do the axial ones towards the caps, because the stress is singular where the free
/// side meets a cap (Szabó & Babuška 1991, ch. 10). Grids with more layers or a higher order contain those
/// with fewer, so that a stiffness falls towards the exact one.
BridgeGrid bridge_grid(const BridgeBody& body, const BridgeResolution& resolution);

}  // namespace pendular::micromechanics
