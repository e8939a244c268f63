#include "packing/diameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "packing/neighbours.h"

namespace pendular {
namespace {

std::vector<Vec3> cubic_lattice(int per_side, double spacing, double jitter) {
  std::vector<Vec3> centres;
  for (int k = 0; k < per_side * per_side * per_side; ++k) {
    const auto c = static_cast<std::uint64_t>(3 * k);
    const Vec3 cell(k % per_side, k / per_side % per_side, k / per_side / per_side);
    const Vec3 noise(random_normal(4, c), random_normal(4, c + 1), random_normal(4, c + 2));
    centres.push_back(spacing * cell + jitter * noise);
  }
  return centres;
}

TEST(Diameters, FarApartTheyAreGaussian) {
  const auto diameters = draw_diameters(cubic_lattice(25, 3.0, 0.0), 1.0, 0.05, 1);
  const double n = static_cast<double>(diameters.size());
  double mean = 0.0, variance = 0.0, third = 0.0;
  for (const double d : diameters) mean += d / n;
  for (const double d : diameters) {
    variance += std::pow(d - mean, 2) / (n - 1.0);
    third += std::pow((d - mean) / 0.05, 3) / n;
  }
  EXPECT_NEAR(mean, 1.0, 4.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(variance), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * n));
  EXPECT_NEAR(third, 0.0, 4.0 * std::sqrt(15.0 / n));
}

TEST(Diameters, NoPairOverlapsAndAllArePositive) {
  for (const double spacing : {1.02, 1.0, 0.97, 0.8, 0.5}) {
    const auto centres = cubic_lattice(14, spacing, 0.02);
    const auto diameters = draw_diameters(centres, 1.0, 0.05, 3);
    EXPECT_TRUE(pairs_within(centres, diameters, 0.0).empty()) << spacing;
    EXPECT_GT(*std::min_element(diameters.begin(), diameters.end()), 0.0) << spacing;
  }
}

TEST(Diameters, EachBeadTouchesAtMostOneNeighbourWhenVisited) {
  const auto centres = cubic_lattice(14, 1.0, 0.01);
  const auto diameters = draw_diameters(centres, 1.0, 0.05, 3);
  const auto touching = pairs_within(centres, diameters, 1e-9).size();
  EXPECT_GT(touching, centres.size() / 20);
  EXPECT_LT(touching, centres.size());
}

TEST(Diameters, FollowTheSeed) {
  const auto centres = cubic_lattice(6, 1.0, 0.02);
  EXPECT_EQ(draw_diameters(centres, 1.0, 0.05, 8), draw_diameters(centres, 1.0, 0.05, 8));
  EXPECT_NE(draw_diameters(centres, 1.0, 0.05, 8), draw_diameters(centres, 1.0, 0.05, 9));
}

TEST(Diameters, TwoBeadsInOnePlaceAreBadInput) {
  const std::vector<Vec3> centres = {{0, 0, 0}, {2, 0, 0}, {2, 0, 0}};
  EXPECT_THROW(draw_diameters(centres, 1.0, 0.05, 1), BadInput);
}

}  // namespace
}  // namespace pendular
