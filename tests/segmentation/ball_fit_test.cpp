#include "segmentation/fit/ball_fit.h"

#include <gtest/gtest.h>

#include "balls.h"
#include "segmentation/fit/ball_profile.h"

namespace pendular::segmentation {
namespace {

using test::ball_volume;

/// The profile against the blur of a ball done by brute force: the share of a Gaussian cloud that lies in it.
TEST(BallProfile, IsTheBlurredBall) {
  const double R = 6.0, s = 1.3;
  for (const double r : {3.0, 5.0, 6.0, 7.0, 9.0}) {
    double sum = 0.0;
    const double h = 0.05;
    for (double x = R * -1.0 + h / 2; x < R; x += h)
      for (double rho = h / 2; rho * rho < R * R - x * x; rho += h)
        sum += 2.0 * M_PI * rho * h * h * std::exp(-0.5 * ((x - r) * (x - r) + rho * rho) / (s * s)) /
               std::pow(2.0 * M_PI * s * s, 1.5);
    EXPECT_NEAR(ball_profile(r, R, s).value, sum, 2e-3) << r;
  }
}

TEST(BallProfile, SlopesAreDerivatives) {
  const double h = 1e-2;
  for (const double r : {18.0, 19.5, 20.5, 22.0}) {
    const BallProfile p = ball_profile(r, 20.0, 1.1);
    EXPECT_NEAR(p.by_radius,
                (ball_profile(r, 20.0 + h, 1.1).value - ball_profile(r, 20.0 - h, 1.1).value) / (2 * h),
                1e-4);
    EXPECT_NEAR(p.by_distance,
                (ball_profile(r + h, 20.0, 1.1).value - ball_profile(r - h, 20.0, 1.1).value) / (2 * h),
                1e-4);
    EXPECT_NEAR(p.by_blur,
                (ball_profile(r, 20.0, 1.1 + h).value - ball_profile(r, 20.0, 1.1 - h).value) / (2 * h),
                1e-4);
  }
}

TEST(BallFit, RecoversOneBallFromAnOffStart) {
  const Vec3 centre(24.3, 23.8, 25.1);
  const Volume volume = ball_volume({50, 50, 50}, {{centre, 14.2}}, 1.0, 0.0);
  const GreyBall start{centre + Vec3(1.0, -1.5, 0.8), 13.0, 15000.0, 8000.0};
  FitSetting setting;
  setting.half_width = 5.0;
  setting.fit_blur = true;
  const BallFit fit = fit_ball(volume, std::span(&start, 1), 0, {}, std::nullopt, setting);
  ASSERT_TRUE(fit.converged);
  EXPECT_LT((fit.ball.centre - centre).norm(), 1e-3);
  EXPECT_NEAR(fit.ball.radius, 14.2, 1e-3);
  EXPECT_NEAR(fit.blur, 1.0, 1e-3);
  EXPECT_NEAR(fit.ball.contrast, 20000.0, 10.0);
}

/// Standard errors against the scatter over many noisy pictures of the same ball.
TEST(BallFit, StandardErrorsMatchTheScatter) {
  constexpr int repeats = 60;
  double centre_scatter = 0.0, radius_scatter = 0.0, sigma_centre = 0.0, sigma_radius = 0.0;
  for (int k = 0; k < repeats; ++k) {
    const Vec3 centre(16.0 + 0.3 * k / repeats, 16.2, 15.9);
    Volume volume = ball_volume({33, 33, 33}, {{centre, 9.0}}, 1.0, 0.0);
    auto& pixels = std::get<std::vector<std::uint16_t>>(volume.pixels);
    for (std::size_t n = 0; n < pixels.size(); ++n)
      pixels[n] = static_cast<std::uint16_t>(
          pixels[n] + std::lround(2000.0 * random_normal(static_cast<std::uint64_t>(k), n)));
    const GreyBall start{centre, 9.0, 20000.0, 10000.0};
    const BallFit fit = fit_ball(volume, std::span(&start, 1), 0, {}, std::nullopt, {});
    centre_scatter += (fit.ball.centre - centre).squaredNorm() / 3.0 / repeats;
    radius_scatter += std::pow(fit.ball.radius - 9.0, 2) / repeats;
    sigma_centre += fit.sigma_centre / repeats;
    sigma_radius += fit.sigma_radius / repeats;
  }
  EXPECT_NEAR(std::sqrt(centre_scatter) / sigma_centre, 1.0, 0.25);
  EXPECT_NEAR(std::sqrt(radius_scatter) / sigma_radius, 1.0, 0.3);
}

/// A touching neighbour pulls an unmasked fit; with the cone and the neighbour's body left out it does not.
TEST(BallFit, NeighbourIsLeftOut) {
  const std::vector<test::TrueBall> truth = {{Vec3(20, 20, 20), 10.0}, {Vec3(40.2, 20, 20), 10.0}};
  const Volume volume = ball_volume({61, 41, 41}, truth, 1.0, 0.0);
  const std::vector<GreyBall> balls = {{truth[0].centre, 10.0, 20000.0, 10000.0},
                                       {truth[1].centre, 10.0, 20000.0, 10000.0}};
  FitSetting setting;
  setting.cone = 5.3;
  const std::vector<Neighbour> neighbour = {{1, true}};
  const BallFit alone = fit_ball(volume, balls, 0, {}, std::nullopt, setting);
  const BallFit masked = fit_ball(volume, balls, 0, neighbour, std::nullopt, setting);
  EXPECT_GT((alone.ball.centre - truth[0].centre).norm(), 0.05);
  EXPECT_LT((masked.ball.centre - truth[0].centre).norm(), 2e-3);
  EXPECT_NEAR(masked.ball.radius, 10.0, 2e-3);
  EXPECT_LT(masked.free_share, alone.free_share);
}

/// With the neighbour's image known no cone is needed, and what is doubted of it shows in the standard error.
TEST(BallFit, NeighbourIsKnown) {
  const std::vector<test::TrueBall> truth = {{Vec3(20, 20, 20), 10.0}, {Vec3(40.2, 20, 20), 10.0}};
  const std::vector<test::TrueBall> grown = {truth[0], {truth[1].centre, 10.1}};
  const std::vector<GreyBall> balls = {{truth[0].centre, 10.0, 20000.0, 10000.0},
                                       {truth[1].centre, 10.0, 20000.0, 10000.0}};
  const auto image = [](double radius) {
    return [radius](const Vec3& p) {
      return 20000.0 * ball_profile((p - Vec3(40.2, 20, 20)).norm(), radius, 1.0).value;
    };
  };
  FitSetting setting;
  setting.cone = 5.3;
  const std::vector<Neighbour> hidden = {{1, true}}, seen = {{1, false}};
  const auto fit_in = [&](const std::vector<test::TrueBall>& there, const KnownGrey& known) {
    return fit_ball(ball_volume({61, 41, 41}, there, 1.0, 0.0), balls, 0, seen, std::nullopt, setting, known);
  };
  const BallFit masked =
      fit_ball(ball_volume({61, 41, 41}, truth, 1.0, 0.0), balls, 0, hidden, std::nullopt, setting);
  const BallFit known = fit_in(truth, {image(10.0), {}});
  EXPECT_LT((known.ball.centre - truth[0].centre).norm(), 2e-3);
  EXPECT_NEAR(known.ball.radius, 10.0, 2e-3);
  EXPECT_GT(known.free_share, masked.free_share + 0.05);

  const GreyAt doubt = [&](const Vec3& p) { return image(10.1)(p) - image(10.0)(p); };
  const BallFit doubted = fit_in(truth, {image(10.0), {doubt}}), wrong = fit_in(grown, {image(10.0), {}});
  const double shift = (wrong.ball.centre - known.ball.centre).norm();
  EXPECT_GT(shift, 1e-3);
  const auto added = [](double with, double without) { return std::sqrt(with * with - without * without); };
  EXPECT_NEAR(std::sqrt(3.0) * added(doubted.sigma_centre, known.sigma_centre) / shift, 1.0, 0.1);
  EXPECT_NEAR(
      added(doubted.sigma_radius, known.sigma_radius) / std::abs(wrong.ball.radius - known.ball.radius), 1.0,
      0.1);
}

}  // namespace
}  // namespace pendular::segmentation
