#include "blind/proportion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pendular::blind {

TEST(Proportion, IntervalIsWilsons) {
  // Newcombe 1998, Stat. Med. 17, 857, table I: 81 of 263 and 0 of 20.
  const auto [low, high] = Proportion{81, 263}.interval_95();
  EXPECT_NEAR(low, 0.2553, 5e-5);
  EXPECT_NEAR(high, 0.3662, 5e-5);
  const auto [none, few] = Proportion{0, 20}.interval_95();
  EXPECT_NEAR(none, 0.0, 1e-12);
  EXPECT_NEAR(few, 0.1611, 5e-5);
  EXPECT_TRUE(std::isnan(Proportion{}.share()));
}

TEST(Proportion, AreaUnderTheCurveCountsTiesHalf) {
  EXPECT_DOUBLE_EQ(area_under_curve({0.9, 0.5}, {0.5, 0.1}), 3.5 / 4.0);
  EXPECT_DOUBLE_EQ(area_under_curve({0.3}, {0.3, 0.3}), 0.5);
  EXPECT_TRUE(std::isnan(area_under_curve({}, {0.1})));
}

TEST(Proportion, Mean) {
  EXPECT_DOUBLE_EQ(mean({1.0, 2.0}), 1.5);
}

}  // namespace pendular::blind
