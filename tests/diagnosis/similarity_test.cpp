#include "diagnosis/kinds/similarity.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

#include "followed.h"

namespace pendular::diagnosis {
namespace {

Similarity placed() {
  Similarity motion;
  motion.rotation =
      (Eigen::AngleAxisd(2.8, Vec3::UnitZ()) * Eigen::AngleAxisd(0.05, Vec3::UnitX())).toRotationMatrix();
  motion.scale = 1.013;
  motion.shift = {40e-6, -30e-6, 15e-6};
  return motion;
}

std::vector<Vec3> places() {
  std::vector<Vec3> all;
  for (const auto& bead : test::followed_specimen()) all.push_back(bead.centre);
  return all;
}

std::vector<Vec3> compression() {
  std::vector<Vec3> all;
  for (const Vec3& at : places()) all.push_back(test::compressed(at, 0.02));
  return all;
}

TEST(Similarity, IsFoundExactly) {
  const Similarity truth = placed();
  std::vector<Vec3> moved;
  for (const Vec3& at : places()) moved.push_back(truth(at));
  const Similarity found = similarity_onto(places(), moved);
  EXPECT_LT((found.rotation - truth.rotation).norm(), 1e-9);
  EXPECT_NEAR(found.scale, truth.scale, 1e-10);
  EXPECT_LT((found.shift - truth.shift).norm(), 1e-12);
}

TEST(Similarity, IsNeverAMirror) {
  std::vector<Vec3> mirrored;
  for (const Vec3& at : places()) mirrored.push_back({-at.x(), at.y(), at.z()});
  EXPECT_NEAR(similarity_onto(places(), mirrored).rotation.determinant(), 1.0, 1e-12);
}

TEST(Similarity, MotionWithoutDeformationIsNone) {
  const Similarity motion = placed();
  std::vector<Vec3> displacement;
  for (const Vec3& at : places()) displacement.push_back(motion(at) - at);
  for (const Vec3& left : without_rigid_motion(places(), displacement)) EXPECT_LT(left.norm(), 1e-13);
}

TEST(Similarity, HowTheSecondScanLiesAndItsVoxelSizeDoNotMatter) {
  const Similarity motion = placed();
  const auto rest = places(), displacement = compression();
  std::vector<Vec3> otherwise;
  for (std::size_t k = 0; k < rest.size(); ++k)
    otherwise.push_back(motion(rest[k] + displacement[k]) - rest[k]);
  const auto one = without_rigid_motion(rest, displacement), other = without_rigid_motion(rest, otherwise);
  for (std::size_t k = 0; k < rest.size(); ++k) EXPECT_LT((one[k] - other[k]).norm(), 1e-13);
}

TEST(Similarity, AStrainWithoutChangeOfVolumeStays) {
  // Beads on a cube: no such strain turns or scales them.
  const double strain = 1e-3;
  std::vector<Vec3> rest, displacement;
  for (int k = 0; k < 216; ++k) {
    rest.push_back(1e-4 * Vec3(k % 6, k / 6 % 6, k / 36));
    displacement.push_back(strain * Vec3(0.5 * rest.back().x(), 0.5 * rest.back().y(), -rest.back().z()));
  }
  const auto left = without_rigid_motion(rest, displacement);
  const Vec3 middle = 2.5e-4 * strain * Vec3(0.5, 0.5, -1.0);
  for (std::size_t k = 0; k < rest.size(); ++k)
    EXPECT_LT((left[k] - (displacement[k] - middle)).norm(), 2.0 * strain * strain * 5e-4);
}

}  // namespace
}  // namespace pendular::diagnosis
