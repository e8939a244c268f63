#include "pipette/track.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "pipette/phantom.h"
#include "pipette/spline.h"

namespace pendular::pipette {
namespace {

constexpr int kSide = 84;
constexpr Region kBox{14, 14, 56, 56};

/// A dark bead with speckles, drawn at an exact shift.
GreyImage drawn(const Point& shift) {
  GreyImage image(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double inside = 26.0 - (Point(x, y) - Point(41.7, 42.2) - shift).norm();
      image.at(x, y) = 0.7 - 0.15 * std::erfc(-inside / (std::sqrt(2.0) * 1.1));
    }
  for (std::uint64_t k = 0; k < 110; ++k) {
    const Point at =
        Point(8.0 + 68.0 * random_uniform(7, 3 * k), 8.0 + 68.0 * random_uniform(7, 3 * k + 1)) + shift;
    const double size = 1.2 + random_uniform(7, 3 * k + 2);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        image.at(x, y) +=
            (k % 2 ? 0.14 : -0.14) * std::exp(-0.5 * (Point(x, y) - at).squaredNorm() / (size * size));
  }
  return image;
}

/// With noise of `sd` of full scale, in steps of the camera.
GreyImage exposed(GreyImage image, double sd, std::uint64_t seed) {
  for (std::size_t k = 0; k < image.values.size(); ++k) {
    image.values[k] += sd * random_normal(seed, k);
    image.values[k] = std::round(255.0 * image.values[k]) / 255.0;
  }
  return image;
}

GreyImage bead(const Point& shift, double sd, std::uint64_t seed) {
  return exposed(drawn(shift), sd, seed);
}

TEST(Spline, PassesThroughPixelsAndReproducesAParabola) {
  GreyImage image(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) image.at(x, y) = 0.3 + 0.01 * x - 0.02 * y + 0.001 * x * y + 0.0005 * x * x;
  const SplineWindow spline(image, {0, 0, 40, 30});
  EXPECT_NEAR(spline.at({17.0, 12.0}).value, image.at(17, 12), 1e-12);
  const auto v = spline.at({17.3, 12.6});
  EXPECT_NEAR(v.value, 0.3 + 0.173 - 0.252 + 0.001 * 17.3 * 12.6 + 0.0005 * 17.3 * 17.3, 1e-7);
  EXPECT_NEAR(v.dx, 0.01 + 0.0126 + 0.0173, 1e-6);
  EXPECT_NEAR(v.dy, -0.02 + 0.0173, 1e-6);
  EXPECT_NEAR(spline.shifted({{15, 10}}, {2.3, 2.6})[0], v.value, 1e-12);
}

struct Error {
  double bias = 0.0, noise = 0.0;  ///< the worst over both axes
};

/// The least sd that any unbiased tracker can have (Cramér–Rao), the worst over both axes.
double least_noise(double sd) {
  const GreyImage image = bead({0.0, 0.0}, 0.0, 1);
  const SplineWindow spline(image, {0, 0, kSide, kSide});
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (int y = kBox.y; y < kBox.y + kBox.height; ++y)
    for (int x = kBox.x; x < kBox.x + kBox.width; ++x) {
      const auto v = spline.at(Point(x, y));
      information += Point(v.dx, v.dy) * Point(v.dx, v.dy).transpose() / (sd * sd);
    }
  return std::sqrt(information.inverse().diagonal().maxCoeff());
}

/// Against the true shift, over `repeats` pairs of a template and a frame, each with its own noise.
Error error_at(double fraction, double sd, int repeats) {
  const Point shift(3.0 + fraction, -2.0 + fraction);
  const GreyImage before = drawn({0.0, 0.0}), after = drawn(shift);
  std::vector<Point> errors(static_cast<std::size_t>(repeats));
  for_blocks(errors.size(), 1, [&](std::size_t k, std::size_t) {
    const Template wanted = make_template(exposed(before, sd, 10000 + k), kBox);
    errors[k] = match(wanted, exposed(after, sd, 100 + k), {2.0, -1.0}, 6).displacement - shift;
  });
  Point mean = Point::Zero(), squares = Point::Zero();
  for (const Point& e : errors) mean += e / repeats;
  for (const Point& e : errors) squares += (e - mean).cwiseAbs2() / (repeats - 1);
  return {mean.cwiseAbs().maxCoeff(), std::sqrt(squares.maxCoeff())};
}

TEST(Track, HasNoPeakLocking) {
  for (double sd : {0.01, 0.02}) {
    double worst_bias = 0.0, worst_noise = 0.0;
    for (int step = 0; step < 20; ++step) {
      const Error error = error_at(0.05 * step, sd, 24);
      EXPECT_LT(error.bias, 0.01) << "shift " << 0.05 * step << ", noise " << sd;
      EXPECT_LT(error.noise, 0.02) << "shift " << 0.05 * step << ", noise " << sd;
      worst_bias = std::max(worst_bias, error.bias);
      worst_noise = std::max(worst_noise, error.noise);
    }
    std::printf("noise %.2f: worst bias %.4f px, worst sd %.4f px, least possible sd %.4f px\n", sd,
                worst_bias, worst_noise, least_noise(sd));
    // The worst of 20 sds from 24 repeats each is about 1.3 times the true one.
    EXPECT_LT(worst_noise, 2.0 * least_noise(sd));
  }
}

TEST(Track, ExactWithoutNoiseUpToTheCamerasSteps) {
  const Template wanted = make_template(bead({0.0, 0.0}, 0.0, 1), kBox);
  for (int step = 0; step < 20; ++step) {
    const Point shift(0.05 * step, -0.35 * step);
    const Match found = match(wanted, bead(shift, 0.0, 1), {0.0, -0.3 * step}, 6);
    ASSERT_TRUE(found.found);
    EXPECT_LT((found.displacement - shift).norm(), 0.004) << step;
    EXPECT_GT(found.score, 0.995);
  }
}

TEST(Track, GainAndOffsetOfTheLightDoNotMatter) {
  const Template wanted = make_template(bead({0.0, 0.0}, 0.01, 1), kBox);
  GreyImage image = bead({1.4, 0.7}, 0.01, 2);
  const Match plain = match(wanted, image, {0.0, 0.0}, 6);
  for (double& v : image.values) v = 0.4 * v + 0.2;
  const Match dimmed = match(wanted, image, {0.0, 0.0}, 6);
  EXPECT_LT((plain.displacement - dimmed.displacement).norm(), 1e-4);
  EXPECT_NEAR(plain.score, dimmed.score, 1e-9);
}

TEST(Track, SaysWhereItIsNotFound) {
  const Template wanted = make_template(bead({0.0, 0.0}, 0.01, 1), kBox);
  GreyImage noise(kSide, kSide);
  for (std::size_t k = 0; k < noise.values.size(); ++k) noise.values[k] = 0.5 + 0.05 * random_normal(3, k);
  EXPECT_LT(match(wanted, noise, {0.0, 0.0}, 6).score, 0.5);
  EXPECT_FALSE(match(wanted, GreyImage(kSide, kSide, 0.3), {0.0, 0.0}, 6).found);
  EXPECT_FALSE(match(wanted, noise, {100.0, 0.0}, 6).found);
  EXPECT_EQ(make_template(GreyImage(kSide, kSide, 0.3), kBox).norm, 0.0);
  GreyImage stripes(kSide, kSide);  // can be followed across, not along
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) stripes.at(x, y) = 0.5 + 0.2 * std::sin(0.6 * x);
  EXPECT_EQ(make_template(stripes, kBox).norm, 0.0);
}

}  // namespace
}  // namespace pendular::pipette
