#pragma once

#include <Eigen/SVD>

#include "base/vec3.h"

namespace pendular::tracking {

/// The proper rotation nearest to a matrix (Kabsch 1976, Acta Cryst. A32, 922; the case of a reflection as in
/// Umeyama 1991, IEEE PAMI 13, 376). Of Σ b aᵀ over vectors a and b it is the rotation that brings all a onto
/// the b with the least squares; of a deformation gradient, its polar rotation.
inline Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handed).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace pendular::tracking
