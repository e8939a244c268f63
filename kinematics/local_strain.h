#pragma once

#include <vector>

#include "base/vec3.h"

namespace pendular::kinematics {

/// Deformation of a bead's surroundings.
struct LocalStrain {
  double shear = 0.0;  ///< √(½ tr(dev E)²) of the Green–Lagrange strain E (Shimizu, Ogata & Li 2007)
  double volumetric = 0.0;  ///< det F − 1
};

/// Per bead, the affine deformation F that best maps the vectors to its neighbours in `start` onto those in
/// `now` (least squares; Falk & Langer 1998, PRE 57, 7192). Neighbours: surfaces closer than a mean
/// diameter at the start, finer than a shear band and coarser than the scatter from bead to bead. Zero where
/// fewer than four neighbours, or neighbours in one plane, leave F undetermined.
std::vector<LocalStrain> local_strains(const std::vector<Vec3>& start, const std::vector<Vec3>& now,
                                       const std::vector<double>& radii);

}  // namespace pendular::kinematics
