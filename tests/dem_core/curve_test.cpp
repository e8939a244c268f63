#include "dem_core/observe/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pendular::dem_core {
namespace {

constexpr double kModulus = 30e6, kToe = 0.006, kLimit = 0.035;

/// A parabolic toe of the given length that joins a line of slope kModulus, then an arc over a peak.
double ideal_stress(double strain) {
  const double x = strain - kToe;
  if (strain < 2.0 * kToe) return 0.25 * kModulus * strain * strain / kToe;
  if (x < kLimit) return kModulus * x;
  const double beyond = x - kLimit;
  return kModulus * (kLimit + beyond * (1.0 - beyond / 0.02));
}

std::vector<CurveRow> ideal_curve(double noise = 0.0) {
  std::vector<CurveRow> rows;
  for (int k = 0; k <= 500; ++k) {
    CurveRow row;
    row.strain = 0.07 * k / 500;
    row.stress = ideal_stress(row.strain) + noise * std::sin(12.9898 * k * k);
    rows.push_back(row);
  }
  return rows;
}

TEST(Curve, FindsModulusToeLimitAndPeak) {
  const auto features = curve_features(ideal_curve());
  ASSERT_TRUE(features);
  EXPECT_NEAR(features->modulus, kModulus, 0.01 * kModulus);
  EXPECT_NEAR(features->toe_strain, kToe, 2e-4);
  // 5 % below the line: beyond²/0.02 = 0.05 (limit + beyond).
  const double beyond = 0.5 * (0.001 + std::sqrt(1e-6 + 0.004 * kLimit));
  EXPECT_NEAR(features->linear_limit.value(), kLimit + beyond, 2e-3);
  EXPECT_NEAR(features->peak_strain, kLimit + 0.01, 1e-3);
  EXPECT_NEAR(features->peak_stress, kModulus * (kLimit + 0.005), 1e4);
  EXPECT_TRUE(features->peak_passed);
}

TEST(Curve, NoiseWithinItsSigma) {
  const auto features = curve_features(ideal_curve(5e3));
  ASSERT_TRUE(features);
  EXPECT_NEAR(features->modulus, kModulus, 0.02 * kModulus);
  EXPECT_GT(features->modulus_sigma, 0.0);
  EXPECT_LT(features->modulus_sigma, 0.01 * kModulus);
}

TEST(Curve, UnloadingLoopsDoNotCount) {
  auto rows = ideal_curve();
  std::vector<CurveRow> with_loop(rows.begin(), rows.begin() + 150);
  for (int k = 149; k > 100; --k) {
    with_loop.push_back(rows[k]);
    with_loop.back().stress = rows[149].stress - 2.0 * kModulus * (rows[149].strain - rows[k].strain);
  }
  with_loop.insert(with_loop.end(), rows.begin() + 101, rows.end());
  EXPECT_NEAR(curve_features(with_loop)->modulus, curve_features(rows)->modulus, 1e-3 * kModulus);
}

TEST(Curve, NothingWhereThereIsNothing) {
  EXPECT_FALSE(curve_features({}));
  std::vector<CurveRow> flat(100);
  for (int k = 0; k < 100; ++k) flat[k].strain = 1e-3 * k;
  EXPECT_FALSE(curve_features(flat));
}

}  // namespace
}  // namespace pendular::dem_core
