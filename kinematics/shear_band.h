#pragma once

#include <vector>

#include "base/vec3.h"

namespace pendular::kinematics {

/// The plane along which shear strain concentrates.
struct ShearBand {
  bool found = false;           ///< contrast of at least 1.3
  Vec3 normal = Vec3::UnitZ();  ///< unit, z ≥ 0
  Vec3 point = Vec3::Zero();    ///< a point of the plane, nearest the centroid of the beads, m
  double thickness = 0.0;       ///< full width at half height of the strain profile across the plane, m
  double contrast = 0.0;        ///< mean shear strain within the slab over the mean outside
  double angle_to_axis = 0.0;   ///< angle between the plane and the z axis, rad
};

/// Searches all planes for the slab, three mean diameters thick, whose mean shear strain stands out most from
/// that of all beads, as a multiple of its standard error. Strains count as no more than their 95th
/// percentile. `shear` is as long as `positions`.
ShearBand find_shear_band(const std::vector<Vec3>& positions, const std::vector<double>& shear,
                          double mean_diameter);

}  // namespace pendular::kinematics
