#include "pipette/line_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace pendular::pipette {
namespace {

struct Points {
  std::vector<double> x, y;
  std::vector<long long> number;
};

/// y = 2 + 30 x (+ bend x²) with x from 0 to 1, errors of `sx`, `sy` and a share `common` of x's error in y.
Points line_points(int n, double sx, double sy, double common, double bend, std::uint64_t seed) {
  Points p;
  for (int k = 0; k < n; ++k) {
    const double x = static_cast<double>(k) / (n - 1);
    const double ex = sx * random_normal(seed, static_cast<std::uint64_t>(2 * k));
    p.x.push_back(x + ex);
    p.y.push_back(2.0 + 30.0 * x + bend * x * x + common * ex +
                  sy * random_normal(seed, static_cast<std::uint64_t>(2 * k + 1)));
    p.number.push_back(k);
  }
  return p;
}

Covariance covariance(double sx, double sy, double common) {
  Covariance c;
  c << sx * sx, common * sx * sx, common * sx * sx, sy * sy + common * common * sx * sx;
  return c;
}

TEST(LineFit, HasNoBiasAndAnHonestSigmaWithErrorsInBoth) {
  for (double common : {0.0, 25.0}) {
    const double sx = 0.08, sy = 1.0;
    double sum = 0.0, squares = 0.0, pulls = 0.0;
    const int cases = 2000;
    for (int k = 0; k < cases; ++k) {
      const Points p = line_points(40, sx, sy, common, 0.0, static_cast<std::uint64_t>(k));
      const auto fit = fit_line(p.x, p.y, covariance(sx, sy, common));
      ASSERT_TRUE(fit);
      sum += fit->slope - 30.0;
      squares += std::pow(fit->slope - 30.0, 2);
      pulls += std::pow((fit->slope - 30.0) / fit->slope_sigma, 2);
    }
    const double sd = std::sqrt(squares / cases);
    EXPECT_LT(std::abs(sum / cases), 0.15 * sd) << "ordinary least squares would be off by 6 %";
    EXPECT_NEAR(std::sqrt(pulls / cases), 1.0, 0.12);
  }
}

TEST(LineFit, IsExactOnALine) {
  const Points p = line_points(10, 0.0, 0.0, 0.0, 0.0, 1);
  const auto fit = fit_line(p.x, p.y, covariance(0.1, 1.0, 0.0));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->slope, 30.0, 1e-9);
  EXPECT_NEAR(fit->intercept, 2.0, 1e-9);
  const std::vector<double> same(10, 1.0);
  EXPECT_FALSE(fit_line(same, p.y, covariance(0.1, 1.0, 0.0)));
}

TEST(Noise, IsReadFromSecondDifferences) {
  const Points p = line_points(4000, 0.02, 0.5, 15.0, 3.0, 5);
  const auto noise = noise_of(p.x, p.y, p.number);
  ASSERT_TRUE(noise);
  const Covariance truth = covariance(0.02, 0.5, 15.0);
  EXPECT_NEAR((*noise)(0, 0) / truth(0, 0), 1.0, 0.12);
  EXPECT_NEAR((*noise)(1, 1) / truth(1, 1), 1.0, 0.12);
  EXPECT_NEAR((*noise)(0, 1) / truth(0, 1), 1.0, 0.2);
}

TEST(LinearRange, TakesAllOfALineAndStopsBeforeABend) {
  const Covariance errors = covariance(0.01, 0.1, 0.0);
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Points p = line_points(60, 0.01, 0.1, 0.0, 0.0, seed);
    const auto range = find_linear_range(p.x, p.y, errors, 8);
    ASSERT_TRUE(range);
    whole += range->points == 60;
  }
  EXPECT_GE(whole, 190);  // 1 % are curved by chance: fewer than 190 of 200 has a probability of 1e-5
  Points kinked = line_points(60, 0.01, 0.1, 0.0, 0.0, 1);
  for (std::size_t k = 36; k < 60; ++k) kinked.y[k] -= 20.0 * (kinked.x[k] - 0.6);
  const auto range = find_linear_range(kinked.x, kinked.y, errors, 8);
  ASSERT_TRUE(range);
  EXPECT_GT(range->points, 32u);
  EXPECT_LT(range->points, 46u);
  EXPECT_NEAR(range->line.slope, 30.0, 4.0 * range->line.slope_sigma);
}

TEST(LinearRange, ThereIsNoneWithoutASlope) {
  Points p = line_points(40, 0.1, 1.0, 0.0, 0.0, 3);
  for (std::size_t k = 0; k < 40; ++k) p.y[k] = random_normal(9, k);
  EXPECT_FALSE(find_linear_range(p.x, p.y, covariance(0.1, 1.0, 0.0), 8));
}

}  // namespace
}  // namespace pendular::pipette
