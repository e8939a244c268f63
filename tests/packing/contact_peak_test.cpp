#include "packing/contact_peak.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measured_beads.h"
#include "packing/bridges.h"

namespace pendular {
namespace {

using test::kBeadSigma;
using test::measured_beads;

// Of a gap, by the errors of two centres along their line and of two diameters.
const double kStated = std::sqrt(2.5) * kBeadSigma;

TEST(ContactPeak, IsAsWideAsTheStatedErrors) {
  const auto peak = contact_peak({measured_beads()});
  ASSERT_TRUE(peak);
  EXPECT_NEAR(peak->stated, kStated, 1e-9 * kStated);
  EXPECT_NEAR(peak->scatter, kStated, 4.0 * peak->sigma_scatter());
  EXPECT_NEAR(peak->position, 0.0, 4.0 * peak->sigma_position() + 0.03e-6);  // the packing's own margin
  EXPECT_NEAR(peak->diameter, 200e-6, 1e-6);
  const double truly = static_cast<double>(candidate_bridges(test::touching_beads(), 0.2e-6).size());
  EXPECT_NEAR(peak->pairs, truly, 0.1 * truly);
}

TEST(ContactPeak, MovesWithTheBiasOfDiameters) {
  for (const double bias : {-6e-6, -1e-6, 0.5e-6, 4e-6}) {
    const auto peak = contact_peak({measured_beads(0.0, bias)});
    ASSERT_TRUE(peak);
    EXPECT_NEAR(peak->position, -bias, 4.0 * peak->sigma_position() + 0.03e-6);
    EXPECT_NEAR(peak->scatter, kStated, 4.0 * peak->sigma_scatter());
  }
}

TEST(ContactPeak, WidensWithNoiseThatIsNotReported) {
  for (const double noise : {0.5e-6, 2e-6, 4e-6}) {
    const auto peak = contact_peak({measured_beads(noise)});
    ASSERT_TRUE(peak);
    const double expected = std::hypot(kStated, M_SQRT2 * noise);
    EXPECT_NEAR(peak->scatter, expected, 0.12 * expected);  // pairs truly apart lie below the peak's flank
    EXPECT_NEAR(peak->position, 0.0, 0.15 * expected);
    EXPECT_NEAR(peak->stated, kStated, 1e-9 * kStated);
  }
}

TEST(ContactPeak, TablesAddUp) {
  const auto one = contact_peak({measured_beads()}), two = contact_peak({measured_beads(), measured_beads()});
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(two->pairs, 2.0 * one->pairs, 1e-6 * one->pairs);
  EXPECT_NEAR(two->position, one->position, 1e-12);
}

TEST(ContactPeak, IsNotSeenWhereNoBeadsTouch) {
  std::vector<Bead> beads = measured_beads();
  for (auto& bead : beads) bead.diameter *= 0.5;
  EXPECT_FALSE(contact_peak({beads}));
  EXPECT_FALSE(contact_peak({}));
  EXPECT_FALSE(contact_peak({{beads[0]}}));
}

}  // namespace
}  // namespace pendular
