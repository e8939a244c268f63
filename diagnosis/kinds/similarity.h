#pragma once

#include <Eigen/Core>

#include <vector>

#include "base/vec3.h"

namespace pendular::diagnosis {

/// The rotation, scale and shift that bring places onto others with the least squares of what is left
/// (Umeyama 1991).
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1.0;
  Vec3 shift = Vec3::Zero();

  Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + shift; }
};
Similarity similarity_onto(const std::vector<Vec3>& from, const std::vector<Vec3>& onto);

/// Displacements without rigid motion and change of scale: what is left of places that moved once they are
/// brought back onto where they were. Any such motion of either gives the same.
std::vector<Vec3> without_rigid_motion(const std::vector<Vec3>& rest, const std::vector<Vec3>& displacement);

}  // namespace pendular::diagnosis
