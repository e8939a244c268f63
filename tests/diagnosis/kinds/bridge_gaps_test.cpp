#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

TEST(BridgeGaps, HaveTheMeanOfTheirDistribution) {
  // A least gap and an exponential excess: its mean is its scale.
  const Observation few = observation(kinds::bridge_gaps(), "gaps", {{"gap_um", {1.0, 2.0, 3.0, 6.0}}});
  EXPECT_EQ(value(few, "gap_mean_um"), 3.0);
  Sample sample;
  sample.bridges.gap = 2e-6;
  sample.effects["bridge_gap_spread"] = 3.0;
  EXPECT_NEAR(value(features_of(Level::readings, few, few.kind->simulate(few, {sample})), "gap_mean_um"), 5.0, 1e-9);
}

TEST(BridgeGaps, TheMeanIsKnownToTheScatterOverTheRootOfTheirNumber) {
  Columns columns;
  for (std::uint64_t k = 0; k < 100; ++k) columns["gap_um"].push_back(-3.0 * std::log(1.0 - random_uniform(9, k)));
  EXPECT_NEAR(sigma(observation(kinds::bridge_gaps(), "gaps", columns), "gap_mean_um"), 0.3, 0.08);
}

}  // namespace
}  // namespace pendular::diagnosis
