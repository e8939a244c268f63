#include "blind/logger.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pendular::blind {
namespace {

std::vector<CurveRow> path(std::initializer_list<double> corners, double step) {
  std::vector<CurveRow> rows;
  double at = *corners.begin();
  for (const double corner : corners)
    for (int left = static_cast<int>(std::lround(std::fabs(corner - at) / step)); left > 0; --left) {
      at += corner > at ? step : -step;
      rows.emplace_back();
      rows.back().strain = at, rows.back().stress = 1e6 * at;
    }
  return rows;
}

}  // namespace

TEST(Logger, KeepsEqualStepsOfEachBranchAndTurnsAtTheNearest) {
  const auto kept = logged(path({0.0, 0.0049, 0.0021, 0.0099}, 1e-4), 1e-3, 0.009);
  const std::vector<double> expected = {0.001, 0.002, 0.003, 0.004, 0.005, 0.004, 0.003, 0.002,
                                        0.003, 0.004, 0.005, 0.006, 0.007, 0.008, 0.009};
  ASSERT_EQ(kept.size(), expected.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_DOUBLE_EQ(kept[k].strain, expected[k]) << k;
    EXPECT_NEAR(kept[k].stress, 1e6 * expected[k], 101.0) << k;  // turns hold what was read there
  }
}

TEST(Logger, KeepsWhatIsReadWhileThePlatenTurns) {
  // The reading of strain rests while stress falls: what is logged at the turn is the stress before it.
  auto rows = path({0.0, 0.005}, 1e-4);
  for (int k = 0; k < 5; ++k) rows.push_back(rows.back()), rows.back().stress -= 500.0;
  for (const auto& row : path({0.005, 0.002}, 1e-4)) rows.push_back(row), rows.back().stress -= 2500.0;
  const auto kept = logged(rows, 1e-3, 0.009);
  ASSERT_EQ(kept.size(), 8u);
  EXPECT_NEAR(kept[4].stress, 5000.0, 1e-6);
  EXPECT_NEAR(kept[5].stress, 1500.0, 1e-6);
}

TEST(Logger, FirstLoadingLeavesOutTheLoop) {
  const auto kept = first_loading(path({0.0, 0.005, 0.002, 0.008}, 1e-3));
  ASSERT_EQ(kept.size(), 8u);
  for (std::size_t k = 1; k < kept.size(); ++k) EXPECT_GT(kept[k].strain, kept[k - 1].strain);
}

}  // namespace pendular::blind
