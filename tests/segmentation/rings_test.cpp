#include "segmentation/fit/rings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "balls.h"

namespace pendular::segmentation {
namespace {

constexpr std::size_t wide = 160, high = 80;
constexpr double edge = 20000.0;

/// Balls of radius 9.3 in rows of their own offsets, so that their cores are at every distance and height.
std::vector<GreyBall> rows_of_balls() {
  std::vector<GreyBall> balls;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 7; ++i)
        balls.push_back(
            {Vec3(20.0 * i + 10.3 + (7 * j) % 20, 20.0 * j + 10.1, 20.0 * k + 10.2 + (7 * i + 11 * j) % 20),
             9.3, edge, 10000.0});
  return balls;
}

/// The balls, noise of a tenth of the edge, and `rings` (slice, distance from the middle) over the edge.
template <typename Function>
Volume volume_with(const Function& rings) {
  std::vector<test::TrueBall> balls;
  for (const GreyBall& ball : rows_of_balls()) balls.push_back({ball.centre, ball.radius});
  Volume volume = test::ball_volume({wide, wide, high}, balls, 1.0, 0.1);
  auto& pixels = std::get<std::vector<std::uint16_t>>(volume.pixels);
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const std::size_t i = n % wide, j = n / wide % wide, k = n / wide / wide;
    const double middle = 0.5 * (wide - 1.0);
    const double away = std::hypot(static_cast<double>(i) - middle, static_cast<double>(j) - middle);
    pixels[n] = static_cast<std::uint16_t>(pixels[n] + std::lround(edge * rings(k, away)));
  }
  return volume;
}

/// Root mean square of what was found less what was put in, over the edge, within the picture's circle. A
/// level in common cannot be told and does not count.
template <typename Function>
double error_of(const Rings& found, const Function& rings) {
  double sum = 0.0, square = 0.0, count = 0.0;
  for (std::size_t k = 12; k < high - 12; ++k)
    for (std::size_t i = 4; i < wide / 2 - 6; ++i) {
      const double away = 0.5 * (wide - 1.0) - static_cast<double>(i);
      const double error = found.at(i, wide / 2, k) / edge - rings(k, std::hypot(away, 0.5));
      sum += error, square += error * error, count += 1.0;
    }
  return std::sqrt(square / count - std::pow(sum / count, 2));
}

double waves(std::size_t, double away) {
  return 0.05 * (std::sin(away * 0.9) + std::sin(away * 0.21));
}

double waves_of_each_slice(std::size_t k, double away) {
  return 0.1 * std::sin(away * 0.9 + 2.1 * static_cast<double>(k * k));
}

TEST(Rings, OfAllSlicesAreFound) {
  const auto found = find_rings(volume_with(waves), rows_of_balls(), 4.0);
  ASSERT_TRUE(found);
  EXPECT_LT(error_of(*found, waves), 0.012);
  EXPECT_NEAR(found->rms / edge, 0.05, 0.01);
}

TEST(Rings, OfSingleSlicesAreFound) {
  const auto found = find_rings(volume_with(waves_of_each_slice), rows_of_balls(), 4.0);
  ASSERT_TRUE(found);
  // Of 0.064, with some five voxels of noise 0.1 for each value.
  EXPECT_LT(error_of(*found, waves_of_each_slice), 0.05);
}

TEST(Rings, AreNotSeenInNoise) {
  EXPECT_FALSE(find_rings(volume_with([](std::size_t, double) { return 0.0; }), rows_of_balls(), 4.0));
}

}  // namespace
}  // namespace pendular::segmentation
