#include "pipette/circles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "pipette/measure.h"
#include "pipette/phantom.h"

namespace pendular::pipette {
namespace {

TEST(Circle, IsFoundThroughAnArcWithStrayPoints) {
  std::vector<Point> points;
  for (int k = 0; k < 120; ++k) {
    const double angle = 0.03 * k, r = 50.0 + 0.1 * random_normal(1, static_cast<std::uint64_t>(k));
    points.emplace_back(20.3 + r * std::cos(angle), -7.1 + r * std::sin(angle));
  }
  for (int k = 0; k < 15; ++k) points.emplace_back(20.3 + 2.0 * k, -7.1);
  const auto circle = fit_circle(points);
  ASSERT_TRUE(circle);
  EXPECT_LT((circle->centre - Point(20.3, -7.1)).norm(), 0.1);
  EXPECT_NEAR(circle->radius, 50.0, 4.0 * circle->radius_sigma);
  EXPECT_NEAR(circle->scatter, 0.1, 0.03);
  EXPECT_FALSE(fit_circle({points.begin(), points.begin() + 5}));
}

TEST(Outline, DiametersOfBeadsAndNeckAreTrue) {
  for (auto direction : {Direction::normal, Direction::tangential}) {
    Phantom phantom;
    phantom.direction = direction;
    const Scene scene = read_scene(phantom_frame(phantom, 0), phantom_calibration(phantom), "phantom");
    // At 1.37 um per pixel the paper's 2 um are 1.5 pixels.
    EXPECT_NEAR(2.0 * scene.fixed.radius, phantom.bead_diameter, 0.4);
    EXPECT_NEAR(2.0 * scene.free.radius, phantom.bead_diameter, 0.4);
    ASSERT_TRUE(scene.neck);
    EXPECT_NEAR(scene.neck->diameter, phantom.neck_diameter, 1.0);
  }
}

TEST(Outline, BeadsAreFoundWithoutRegions) {
  for (auto direction : {Direction::normal, Direction::tangential}) {
    Phantom phantom;
    phantom.direction = direction;
    Calibration calibration = phantom_calibration(phantom);
    const Scene given = read_scene(phantom_frame(phantom, 0), calibration, "phantom");
    calibration.bead_fixed = calibration.bead_free = std::nullopt;
    calibration.expected_diameter *= 1.1;
    Scene found = read_scene(phantom_frame(phantom, 0), calibration, "phantom");
    // In a tangential test it is the motion that tells which bead is the wafer's.
    if (direction == Direction::tangential && found.fixed.centre.x() < found.free.centre.x())
      std::swap(found.fixed, found.free);
    EXPECT_LT((given.fixed.centre - found.fixed.centre).norm(), 0.2);
    EXPECT_LT((given.free.centre - found.free.centre).norm(), 0.2);
    EXPECT_NEAR(given.free.radius, found.free.radius, 0.2);
  }
}

/// What read_scene() says of a picture.
std::string complaint(const GreyImage& image, const Calibration& calibration) {
  try {
    read_scene(image, calibration, "first");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Scene, SaturatedAndConstantPicturesAreRefused) {
  const Phantom phantom;
  const Calibration calibration = phantom_calibration(phantom);
  GreyImage image = phantom_frame(phantom, 0);
  GreyImage bright = image, dim = image, clipped = image;
  for (double& v : bright.values) v = std::min(1.0, 1.6 * v);
  for (double& v : dim.values) v = 0.3 + 1e-3 * v;
  for (double& v : clipped.values) v = v < 0.45 ? 0.0 : v;  // the beads' rims are black, the rest is not
  EXPECT_NE(complaint(bright, calibration).find("saturated"), std::string::npos);
  EXPECT_NE(complaint(clipped, calibration).find("bead_fixed: "), std::string::npos);
  EXPECT_NE(complaint(clipped, calibration).find("saturated"), std::string::npos);
  EXPECT_NE(complaint(dim, calibration).find("constant picture"), std::string::npos);
}

}  // namespace
}  // namespace pendular::pipette
