#include <gtest/gtest.h>

#include "base/random.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

Observation necks(double spread, double error, bool stated) {
  Columns columns;
  for (std::uint64_t k = 0; k < 400; ++k) {
    columns["d_um"].push_back(74.0 + spread * random_normal(3, k) + error * random_normal(4, k));
    if (stated) columns["sigma_um"].push_back(error);
  }
  return observation(kinds::bridge_diameters(), "necks", columns);
}

TEST(BridgeDiameters, MeanAndSpreadAreThoseOfTheSample) {
  const Observation plain = necks(12.0, 0.0, false);
  EXPECT_NEAR(value(plain, "diameter_mean"), 74.0, 2.0);
  EXPECT_NEAR(value(plain, "diameter_spread"), 12.0 / 74.0, 0.02);
  // Of the mean, as a logarithm: the spread over the root of their number.
  EXPECT_NEAR(sigma(plain, "diameter_mean"), 12.0 / 74.0 / 20.0, 0.3 * 12.0 / 74.0 / 20.0);
}

TEST(BridgeDiameters, HaveTheStatedSpreadUnlessTheEffectIsLarger) {
  const Observation rows =
      observation(kinds::bridge_diameters(), "necks", {{"d_um", std::vector<double>(50, 70.0)}});
  Sample sample;
  sample.bridges.diameter = 70e-6, sample.bridges.diameter_sd = 7e-6;
  const auto simulated = [&](const char* name) {
    return value(features_of(Level::readings, rows, rows.kind->simulate(rows, {sample})), name);
  };
  EXPECT_NEAR(simulated("diameter_spread"), 0.1, 1e-9);
  EXPECT_NEAR(simulated("diameter_mean"), 70.0, 1e-9);
  sample.effects["bridge_diameter_spread"] = 14.0;
  EXPECT_NEAR(simulated("diameter_spread"), 0.2, 1e-9);
}

}  // namespace
}  // namespace pendular::diagnosis
