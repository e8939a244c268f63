#include "diagnosis/kinds/similarity.h"

#include <Eigen/SVD>

namespace pendular::diagnosis {

Similarity similarity_onto(const std::vector<Vec3>& from, const std::vector<Vec3>& onto) {
  const double n = static_cast<double>(from.size());
  Vec3 middle = Vec3::Zero(), goal = Vec3::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) middle += from[k] / n, goal += onto[k] / n;
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  double square = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    product += (onto[k] - goal) * (from[k] - middle).transpose();
    square += (from[k] - middle).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign.z() = -1.0;
  Similarity found;
  found.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  found.scale = square > 0.0 ? svd.singularValues().dot(sign) / square : 1.0;
  found.shift = goal - found.scale * (found.rotation * middle);
  return found;
}

std::vector<Vec3> without_rigid_motion(const std::vector<Vec3>& rest, const std::vector<Vec3>& displacement) {
  std::vector<Vec3> moved;
  for (std::size_t k = 0; k < rest.size(); ++k) moved.push_back(rest[k] + displacement[k]);
  const Similarity back = similarity_onto(moved, rest);
  for (std::size_t k = 0; k < rest.size(); ++k) moved[k] = back(moved[k]) - rest[k];
  return moved;
}

}  // namespace pendular::diagnosis
