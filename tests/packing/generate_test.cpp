#include "packing/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "packing/bridges.h"
#include "packing/neighbours.h"
#include "packing/statistics.h"

namespace pendular {
namespace {

Sample small_sample(double volume_fraction, double width = 10.0) {
  Sample sample;
  sample.specimen.diameter = width * sample.beads.diameter;
  sample.specimen.height = width * sample.beads.diameter;
  sample.specimen.volume_fraction = volume_fraction;
  return sample;
}

std::vector<double> coordinates(const Packing& packing) {
  std::vector<double> values;
  for (const auto& b : packing.beads)
    values.insert(values.end(), {b.centre.x(), b.centre.y(), b.centre.z(), b.diameter});
  return values;
}

class Generated : public ::testing::TestWithParam<double> {};

TEST_P(Generated, FillsTheCylinderWithoutOverlap) {
  const Sample sample = small_sample(GetParam(), GetParam() > 0.59 ? 14.0 : 10.0);
  const Packing packing = generate_packing(sample, 2);
  const PackingStatistics statistics = packing_statistics(packing, 0.064 * sample.beads.diameter);
  EXPECT_NEAR(statistics.volume_fraction, GetParam(), 0.002);
  EXPECT_NEAR(statistics.mean_diameter, sample.beads.diameter,
              5.0 * sample.beads.diameter_sd / std::sqrt(statistics.beads));
  EXPECT_TRUE(pairs_within(centres_of(packing.beads), diameters_of(packing.beads), 0.0).empty());
  for (const auto& bead : packing.beads) {
    EXPECT_LE(std::hypot(bead.centre.x(), bead.centre.y()) + 0.5 * bead.diameter,
              0.5 * packing.specimen.diameter);
    EXPECT_GE(bead.centre.z(), 0.5 * bead.diameter);
    EXPECT_LE(bead.centre.z() + 0.5 * bead.diameter, packing.specimen.height);
  }
}

INSTANTIATE_TEST_SUITE_P(Fractions, Generated, ::testing::Values(0.50, 0.55, 0.58, 0.60));

TEST(Generate, SameForAnyNumberOfThreadsOtherForAnotherSeed) {
  const Sample sample = small_sample(0.56, 8.0);
  set_threads(1);
  const auto one = coordinates(generate_packing(sample, 4));
  set_threads(2);
  const auto two = coordinates(generate_packing(sample, 4));
  const auto other = coordinates(generate_packing(sample, 5));
  set_threads(0);
  EXPECT_EQ(one, two);
  EXPECT_NE(one, other);
}

/// Octahedra of a crystal put neighbours at √2 D, where the pair correlation of a glass has its minimum.
TEST(Generate, IsNoCrystal) {
  const Packing packing = generate_packing(small_sample(0.60, 14.0), 3);
  const double D = mean_diameter(packing.beads);
  const double density =
      6.0 / M_PI * volume_fraction_within(packing.beads, core_of(packing.specimen, 2.5 * D));
  const Specimen core = core_of(packing.specimen, 2.5 * D);
  const auto pair_correlation = [&](double from, double to) {
    double pairs = 0.0, beads = 0.0;
    for (const auto& a : packing.beads) {
      const bool inside = std::hypot(a.centre.x(), a.centre.y()) < 0.5 * core.diameter &&
                          std::abs(a.centre.z() - core.bottom - 0.5 * core.height) < 0.5 * core.height;
      if (!inside) continue;
      beads += 1.0;
      for (const auto& b : packing.beads) {
        const double r = (a.centre - b.centre).norm() / D;
        pairs += r > from && r < to;
      }
    }
    return pairs / beads / (4.0 / 3.0 * M_PI * (to * to * to - from * from * from) * density);
  };
  EXPECT_GT(pair_correlation(1.0, 1.1), 3.0);
  EXPECT_LT(pair_correlation(1.36, 1.46), 0.9);
  EXPECT_GT(pair_correlation(1.65, 1.8), 1.05);
}

TEST(Generate, RefusesAPackingNoneCanReach) {
  EXPECT_THROW(generate_packing(small_sample(0.60, 1.5), 1), BadInput);
  EXPECT_THROW(generate_packing(small_sample(0.64, 2.2), 1), ComputationFailed);
}

}  // namespace
}  // namespace pendular
