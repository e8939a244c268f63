#include "reproduction/ensemble.h"

#include <gtest/gtest.h>

namespace pendular::reproduction {
namespace {

/// Stress that rises with a slope to 5 % of strain, then falls to half.
RunFolder made_up_run(double slope) {
  RunFolder run;
  for (int k = 0; k <= 100; ++k) {
    const double strain = 0.001 * k;
    run.strain.push_back(strain);
    run.stress.push_back(strain <= 0.05 ? slope * strain : slope * 0.05 * (1.0 - 10.0 * (strain - 0.05)));
  }
  run.result.modulus = slope;
  run.result.toe = 0.01;
  run.result.linear_limit = 0.04;
  run.result.bonds = 200;
  run.break_strain = {0.02, 0.03, 0.05, 0.06, 0.07};
  return run;
}

TEST(Ensemble, SpreadIsMeanAndStandardDeviationOfWhatIsThere) {
  const double values[] = {2.0, 4.0, std::nan(""), 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.count, 8u);
  EXPECT_DOUBLE_EQ(spread.mean, 5.0);
  EXPECT_NEAR(spread.sd, std::sqrt(32.0 / 7.0), 1e-12);
  const Spread one = spread_of(std::span(values, 1));
  EXPECT_EQ(one.mean, 2.0);
  EXPECT_TRUE(std::isnan(one.sd));
  EXPECT_TRUE(std::isnan(spread_of(std::span<const double>()).mean));
}

TEST(Ensemble, NumbersOfARun) {
  const auto run = made_up_run(20e6);
  EXPECT_NEAR(slope_at_fixed_strain(run), 20e6, 1.0);
  EXPECT_NEAR(stress_kept(run), 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(broken_share_before_limit(run), 3.0 / 200.0) << "the limit is toe + 4 % = 5 %, inclusive";
  EXPECT_TRUE(std::isnan(band_contrast(run)));
}

TEST(Ensemble, APointWithoutTheStrainHasNoSlope) {
  auto run = made_up_run(1e6);
  run.strain.resize(15);
  run.stress.resize(15);
  EXPECT_TRUE(std::isnan(slope_at_fixed_strain(run)));
}

TEST(Ensemble, PointsAverageOverRuns) {
  Point point;
  point.runs = {made_up_run(10e6), made_up_run(14e6)};
  point.runs.push_back(made_up_run(1e6));
  point.runs.back().result.modulus.reset();
  EXPECT_EQ(in_words(spread_of(point, modulus), 1e6), "12.0 ± 2.8");
  EXPECT_EQ(in_words(Spread{}, 1.0), "–");
}

}  // namespace
}  // namespace pendular::reproduction
