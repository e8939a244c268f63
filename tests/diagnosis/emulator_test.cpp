#include "diagnosis/emulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::VectorXd two(double a, double b) {
  return Eigen::Vector2d(a, b);
}

TEST(Emulator, FindsAQuadratic) {
  std::vector<PairedRun> runs;
  for (double theta : {0.1, 0.2, 0.3}) runs.push_back({theta, two(2.0 * theta - theta * theta, -theta)});
  const auto fitted = fit_signature("e", runs, 2);
  EXPECT_NEAR(fitted.signature.at(0.25)[0], 2.0 * 0.25 - 0.0625, 1e-12);
  EXPECT_NEAR(fitted.signature.at(0.25)[1], -0.25, 1e-12);
  EXPECT_NEAR(fitted.freedom, 1.0, 1e-12);
  EXPECT_LT(fitted.residuals.norm(), 1e-12);
}

TEST(Emulator, UsesWhatRunsShow) {
  // The second feature is seen at two magnitudes only: a straight line; a third is never seen: nothing.
  std::vector<PairedRun> runs;
  for (double theta : {0.1, 0.2, 0.3})
    runs.push_back({theta, Eigen::Vector3d(theta, theta < 0.25 ? 3.0 * theta : kNaN, kNaN)});
  const auto fitted = fit_signature("e", runs, 3);
  EXPECT_NEAR(fitted.signature.linear[1], 3.0, 1e-12);
  EXPECT_EQ(fitted.signature.curved[1], 0.0);
  EXPECT_EQ(fitted.signature.linear[2], 0.0);
  EXPECT_TRUE(fitted.residuals.allFinite());
}

TEST(Emulator, PooledCovarianceIsThatOfTheNoise) {
  // Forty effects of six runs each, with noise of sd 0.1 and 0.2 and a correlation of 0.6.
  std::vector<Eigen::MatrixXd> residuals;
  double freedom = 0.0;
  for (std::uint64_t effect = 0; effect < 40; ++effect) {
    std::vector<PairedRun> runs;
    for (std::uint64_t run = 0; run < 6; ++run) {
      const double a = random_normal(effect, 2 * run), b = random_normal(effect, 2 * run + 1);
      const double theta = 0.1 * static_cast<double>(1 + run % 3);
      runs.push_back({theta, two(theta + 0.1 * a, 0.2 * (0.6 * a + 0.8 * b))});
    }
    const auto fitted = fit_signature("e", runs, 2);
    residuals.push_back(fitted.residuals);
    freedom += fitted.freedom;
  }
  EXPECT_NEAR(freedom, 160.0, 1e-9);
  const auto pooled = pooled_covariance(residuals, freedom);
  EXPECT_NEAR(pooled.covariance(0, 0), 0.01, 0.0025);
  EXPECT_NEAR(pooled.covariance(1, 1), 0.04, 0.01);
  EXPECT_NEAR(pooled.covariance(0, 1) / std::sqrt(pooled.covariance(0, 0) * pooled.covariance(1, 1)), 0.6,
              0.12);
}

TEST(Emulator, FewRunsDoNotPretendToKnowCorrelations) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Constant(1, 6, 1.0);
  const auto pooled = pooled_covariance({one}, 1.0);
  EXPECT_NEAR(pooled.covariance(0, 1), 1.0 / 7.0, 1e-12);
  EXPECT_NEAR(pooled.covariance(0, 0), 1.0, 1e-12);
}

}  // namespace
}  // namespace pendular::diagnosis
