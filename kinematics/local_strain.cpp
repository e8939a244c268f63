#include "kinematics/local_strain.h"

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "packing/neighbours.h"

namespace pendular::kinematics {

std::vector<LocalStrain> local_strains(const std::vector<Vec3>& start, const std::vector<Vec3>& now,
                                       const std::vector<double>& radii) {
  std::vector<double> diameters;
  for (double radius : radii) diameters.push_back(2.0 * radius);
  const double mean =
      std::accumulate(diameters.begin(), diameters.end(), 0.0) / static_cast<double>(diameters.size());
  struct Moments {
    Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero(), square = Eigen::Matrix3d::Zero();
    int neighbours = 0;
  };
  std::vector<Moments> moments(start.size());
  for (const auto& [i, j] : pairs_within(start, diameters, mean)) {
    const Vec3 before = start[i] - start[j], after = now[i] - now[j];
    const Eigen::Matrix3d mixed = after * before.transpose(), square = before * before.transpose();
    for (int bead : {i, j}) {
      moments[bead].mixed += mixed;
      moments[bead].square += square;
      ++moments[bead].neighbours;
    }
  }
  std::vector<LocalStrain> strains(start.size());
  for (std::size_t k = 0; k < start.size(); ++k) {
    const double scale = moments[k].square.trace() / 3.0;
    if (moments[k].neighbours < 4 || moments[k].square.determinant() < 1e-3 * scale * scale * scale) continue;
    const Eigen::Matrix3d gradient = moments[k].mixed * moments[k].square.inverse();
    const Eigen::Matrix3d green = 0.5 * (gradient.transpose() * gradient - Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d deviator = green - green.trace() / 3.0 * Eigen::Matrix3d::Identity();
    strains[k] = {std::sqrt(0.5 * deviator.squaredNorm()), gradient.determinant() - 1.0};
  }
  return strains;
}

}  // namespace pendular::kinematics
