#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

#include "followed.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::value;

/// Beads at `places` that moved as `motion` says, both in µm.
template <typename Motion>
Columns scan(const std::vector<Vec3>& places, double strain, const Motion& motion) {
  Columns columns;
  for (std::size_t k = 0; k < places.size(); ++k) {
    columns["strain"].push_back(strain);
    columns["bead_id"].push_back(static_cast<double>(k + 1));
    const Vec3 u = motion(places[k]);
    for (const auto& [name, v] : {std::pair("x_um", places[k].x()),
                                  {"y_um", places[k].y()},
                                  {"z_um", places[k].z()},
                                  {"ux_um", u.x()},
                                  {"uy_um", u.y()},
                                  {"uz_um", u.z()}})
      columns[name].push_back(v);
  }
  return columns;
}

std::vector<Vec3> grid() {
  std::vector<Vec3> places;
  for (int k = 0; k < 512; ++k) places.push_back(500.0 * Vec3(k % 8, k / 8 % 8, k / 64));
  return places;
}

TEST(Displacements, LandmarksOfAnAffineMotion) {
  // Strain along z 0.8 of the platen's, expansion across it 0.3 of it; a gradient of u_z along x of 0.1, half of
  // which is a turn of the whole.
  const double strain = 0.002;
  const Observation tracked =
      observation(kinds::displacements(), "scan", scan(grid(), strain, [&](const Vec3& at) -> Vec3 {
                    return strain * Vec3(0.3 * at.x(), 0.3 * at.y(), -0.8 * at.z() + 0.1 * at.x());
                  }));
  EXPECT_NEAR(value(tracked, "deviatoric_share"), 1.1, 0.004);  // strains are small but finite
  EXPECT_NEAR(value(tracked, "tilt_share"), 0.05, 0.002);
  EXPECT_NEAR(value(tracked, "wandering"), 0.0, 1e-9);
}

TEST(Displacements, ATurnedShiftedAndScaledScanHasTheSameFieldAndLandmarks) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.9, Vec3(0.02, -0.03, 1.0).normalized()).toRotationMatrix();
  const auto motion = [](const Vec3& at) -> Vec3 { return 1e6 * test::compressed(1e-6 * at, 0.02); };
  const Observation one = observation(kinds::displacements(), "one", scan(grid(), 0.02, motion)),
                    other = observation(
                        kinds::displacements(), "other", scan(grid(), 0.02, [&](const Vec3& at) -> Vec3 {
                          return 0.995 * (turn * (at + motion(at))) + Vec3(30, -20, 10) - at;
                        }));
  const Eigen::VectorXd of_one = one.kind->field(one, one.columns), of_other = other.kind->field(other, other.columns);
  EXPECT_GT(of_one.norm(), 1e-4);
  EXPECT_LT((of_one - of_other).norm(), 1e-9 * of_one.norm());
  for (const auto& feature : features_of(Level::landmarks, one, one.columns))
    EXPECT_NEAR(value(other, feature.name), feature.value, 1e-9) << feature.name;
}

TEST(Displacements, AreSimulatedByTheNearestFrameForTheBeadsThatWereFollowed) {
  // Four beads, of which one was lost by the scan; the frame is a little short of it.
  SimulatedTest test;
  test.frames.resize(2);
  test.frames[0].strain = 0.005, test.frames[1].strain = 0.018;
  for (auto& frame : test.frames)
    for (int k = 0; k < 4; ++k) {
      frame.ids.push_back(10 + k);
      frame.rest.push_back(1e-4 * Vec3(k, 0, 0));
      frame.displacement.push_back(frame.strain * Vec3(0, 0, -1e-3 * k));
    }
  Observation tracked = observation(kinds::displacements(), "scan",
                                    {{"strain", {0.02, 0.02, 0.02}}, {"bead_id", {13, 10, 12}}});
  tracked.beads = "beads.csv";
  const Columns columns = tracked.kind->simulate(tracked, {Sample{}, &test});
  EXPECT_EQ(columns.at("bead_id"), (std::vector{13.0, 10.0, 12.0}));
  EXPECT_NEAR(columns.at("x_um")[0], 300.0, 1e-9);
  EXPECT_NEAR(columns.at("uz_um")[0], -60.0, 1e-9);  // 2 % of 3 mm
  tracked.beads.clear();
  EXPECT_EQ(tracked.kind->simulate(tracked, {Sample{}, &test}).at("bead_id").size(), 4u);
}

TEST(Displacements, NoiseHasTheStatedSizeAlongEachAxis) {
  Columns columns = scan(grid(), 0.02, [](const Vec3&) -> Vec3 { return Vec3::Zero(); });
  columns["sigma_um"] = std::vector<double>(512, 0.4);
  const Observation tracked = observation(kinds::displacements(), "scan", columns);
  const Columns again = tracked.kind->perturbed(tracked, 3);
  double product = 0.0;
  for (const char* axis : {"ux_um", "uy_um", "uz_um"}) {
    double square = 0.0;
    for (const double u : again.at(axis)) square += u * u / 512.0;
    EXPECT_NEAR(std::sqrt(square), 0.4, 0.05) << axis;
  }
  for (std::size_t k = 0; k < 512; ++k) product += again.at("ux_um")[k] * again.at("uy_um")[k] / 512.0;
  EXPECT_NEAR(product, 0.0, 4.0 * 0.16 / std::sqrt(512.0));  // axes are independent
  EXPECT_EQ(again.at("x_um"), tracked.column("x_um"));
}

TEST(Displacements, ItsTestKeepsAFrameAtRestAndAtItsStrain) {
  const Observation tracked =
      observation(kinds::displacements(), "scan", scan(grid(), 0.02, [](const Vec3&) -> Vec3 { return Vec3::Zero(); }));
  Sample::Compression course;
  tracked.kind->course(tracked, course);
  EXPECT_EQ(course.frame_at.front(), kRestStrain);
  EXPECT_DOUBLE_EQ(course.frame_at.back(), 0.02);
}

TEST(Displacements, ErrorsOfTheSimulationAreAPositiveDefiniteCovariance) {
  const Observation tracked = observation(
      kinds::displacements(), "scan",
      scan(grid(), 0.02, [](const Vec3& at) -> Vec3 { return 1e6 * test::compressed(1e-6 * at, 0.02); }));
  const auto landmarks = features_of(Level::landmarks, tracked, tracked.columns);
  ASSERT_EQ(landmarks.size(), 3u);
  test::expect_covariance(tracked.kind->model_error(landmarks), landmarks.size());
}

}  // namespace
}  // namespace pendular::diagnosis
