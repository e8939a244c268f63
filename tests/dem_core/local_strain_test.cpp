#include "kinematics/local_strain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "kinematics/shear_band.h"

namespace pendular::dem_core {
namespace {

constexpr double kD = 2e-4;

/// A jittered cubic lattice of side × side × side beads of diameter kD.
std::vector<Vec3> lattice(int side) {
  std::vector<Vec3> points;
  std::uint64_t n = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k) {
        const Vec3 jitter(random_uniform(3, n), random_uniform(4, n), random_uniform(5, n));
        points.push_back(1.05 * kD * Vec3(i, j, k) + 0.2 * kD * jitter);
        ++n;
      }
  return points;
}

TEST(LocalStrain, AffineDeformationIsFoundExactly) {
  Eigen::Matrix3d gradient;
  gradient << 1.02, 0.05, 0.0, 0.0, 0.97, -0.03, 0.01, 0.0, 0.94;
  const auto start = lattice(6);
  std::vector<Vec3> now;
  for (const auto& x : start)
    now.push_back(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * (gradient * x) + Vec3(1, 2, 3));
  const Eigen::Matrix3d green = 0.5 * (gradient.transpose() * gradient - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d deviator = green - green.trace() / 3 * Eigen::Matrix3d::Identity();
  std::size_t undetermined = 0;
  for (const auto& strain :
       kinematics::local_strains(start, now, std::vector<double>(start.size(), 0.5 * kD))) {
    if (strain.shear == 0.0) {
      ++undetermined;  // a corner with too few neighbours
      continue;
    }
    EXPECT_NEAR(strain.shear, deviator.norm() / std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(strain.volumetric, gradient.determinant() - 1.0, 1e-9);
  }
  EXPECT_LE(undetermined, 8u);
}

TEST(ShearBand, PlantedBandIsFound) {
  const auto points = lattice(14);
  for (double angle : {25.0, 40.0, 60.0}) {
    const double a = angle * M_PI / 180.0;
    const Vec3 normal = Vec3(std::cos(a) * std::cos(0.5), std::cos(a) * std::sin(0.5), std::sin(a));
    const Vec3 through = 1.05 * kD * Vec3(7, 7, 7);
    std::vector<double> shear;
    for (std::size_t k = 0; k < points.size(); ++k)
      shear.push_back(0.01 + 0.005 * random_uniform(9, k) +
                      0.1 * (std::fabs((points[k] - through).dot(normal)) < 1.5 * kD));
    const kinematics::ShearBand band = kinematics::find_shear_band(points, shear, kD);
    EXPECT_TRUE(band.found);
    EXPECT_LT(std::acos(std::fabs(band.normal.dot(normal))), 5.0 * M_PI / 180.0) << angle;
    EXPECT_NEAR(band.angle_to_axis, a, 5.0 * M_PI / 180.0);
    EXPECT_LT(std::fabs((band.point - through).dot(normal)), 0.6 * kD);
    EXPECT_NEAR(band.thickness, 3.0 * kD, 1.1 * kD);
  }
}

TEST(ShearBand, UniformStrainHasNone) {
  const auto points = lattice(12);
  std::vector<double> shear;
  for (std::size_t k = 0; k < points.size(); ++k) shear.push_back(0.02 + 0.02 * random_uniform(1, k));
  EXPECT_FALSE(kinematics::find_shear_band(points, shear, kD).found);
}

}  // namespace
}  // namespace pendular::dem_core
