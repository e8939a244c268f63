#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pendular {

/// A point or vector in space, SI units, axis order x, y, z.
using Vec3 = Eigen::Vector3d;

}  // namespace pendular
