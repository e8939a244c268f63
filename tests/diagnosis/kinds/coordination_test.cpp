#include <gtest/gtest.h>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

TEST(Coordination, IsComparedByRatioWithinItsStatedError) {
  const Observation z = observation(kinds::coordination(), "Z", {{"z", {6.0}}, {"z_sigma", {0.12}}});
  EXPECT_EQ(value(z, "coordination"), 6.0);
  EXPECT_NEAR(sigma(z, "coordination"), 0.02, 0.003);
  EXPECT_EQ(value(z, "coordination", Level::readings), 6.0);
  SimulatedTest test;
  test.coordination = 5.5;
  EXPECT_EQ(z.kind->simulate(z, {Sample{}, &test}).at("z"), std::vector{5.5});
}

TEST(Coordination, StaysPositiveWhateverItsError) {
  const Observation z = observation(kinds::coordination(), "Z", {{"z", {1.0}}, {"z_sigma", {2.0}}});
  for (unsigned long seed = 0; seed < 200; ++seed) EXPECT_GT(z.kind->perturbed(z, seed).at("z")[0], 0.0);
}

}  // namespace
}  // namespace pendular::diagnosis
