#include "base/quantity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pendular {
namespace {

TEST(Quantity, DigitsFollowTheInterval) {
  EXPECT_EQ(quantity(0.1967, {0.1802, 0.2121}, "fraction"), "20 % (18 to 21 %)");
  EXPECT_EQ(quantity(0.1967, {0.1952, 0.1981}, "fraction"), "19.67 % (19.52 to 19.81 %)");
  EXPECT_EQ(quantity(0.2041, {0.1512, 0.2577}, "1"), "0.20 (0.15 to 0.26)");
  EXPECT_EQ(quantity(4.0712, {3.82, 4.36}, "um"), "4.1 µm (3.8 to 4.4 µm)");
  EXPECT_EQ(quantity(-0.31, {-0.62, -0.004}, "fraction"), "-31 % (-62 to 0 %)");
  EXPECT_EQ(quantity_within(-5.45e-6, 0.002, "fraction"), "0.0 %");
  EXPECT_EQ(quantity_within(12.34567, 0.02, "um"), "12.35 µm");
  EXPECT_EQ(quantity(142.3, {20.1, 260.9}, "um"), "142 µm (20 to 261 µm)");
}

TEST(Quantity, SpellsUnits) {
  EXPECT_EQ(quantity(0.3, "degrees"), "0.3°");
  EXPECT_EQ(quantity(3.14159, "um/N"), "3.14 µm/N");
  EXPECT_EQ(quantity(0.05, "strain"), "5 %");
  EXPECT_EQ(quantity(1.5e6, "Pa"), "1.5 MPa");
  EXPECT_EQ(quantity(7.5e4, "Pa"), "75 kPa");
  EXPECT_EQ(quantity(1.2, {0.9, 1.5}, "multiple"), "1.2 (0.9 to 1.5) times");
  EXPECT_EQ(quantity(2.0, "furlongs"), "2 furlongs");
  EXPECT_EQ(quantity(std::pair(9.0e5, 1.1e6), "Pa"), "0.90 to 1.10 MPa");
}

TEST(Quantity, WhatIsNotKnownIsNotTold) {
  EXPECT_EQ(quantity(std::nan(""), "um"), "");
  EXPECT_EQ(quantity(2.0, {2.0, 2.0}, "um"), "2 µm");
  EXPECT_EQ(quantity(2.0, {1.0, std::nan("")}, "um"), "2 µm");
}

TEST(Quantity, SharesAreNeverQuiteAllOrNothing) {
  EXPECT_EQ(percent(0.0), "0 %");
  EXPECT_EQ(percent(0.001), "<1 %");
  EXPECT_EQ(percent(0.974), "97 %");
  EXPECT_EQ(percent(0.9996), ">99 %");
  EXPECT_EQ(percent(1.0), "100 %");
}

}  // namespace
}  // namespace pendular
