#include "tests.h"

namespace pendular::effects::test {
namespace {

micromechanics::BridgeBody body_at(double content, double theta) {
  Sample sample = with("funicular_bridges", theta);
  set_polymer_content(sample, content);
  return actual_specimen(chains(), sample, 1).bodies.front();
}

TEST(FunicularBridges, TakesVolumeFromTheBridgesAboveTheTransition) {
  const auto square = [](double d) { return d * d; };
  const double below = body_at(0.027, 1.0).neck_diameter;
  // All above W* carries no load: the bridges are those of W*.
  EXPECT_NEAR(body_at(0.04, 1.0).neck_diameter, below, 1e-9 * below);
  // Half of it: W ∝ d².
  EXPECT_NEAR(square(body_at(0.04, 0.5).neck_diameter) / square(below), (0.027 + 0.0065) / 0.027, 1e-9);
  EXPECT_DOUBLE_EQ(body_at(0.02, 1.0).neck_diameter, body_at(0.02, 0.0).neck_diameter);
}

TEST(FunicularBridges, LowersTheModulusAboveTheTransitionOnly) {
  Sample sample = with("funicular_bridges", 1.0);
  set_polymer_content(sample, 0.06);
  EXPECT_LT(modulus(disordered(4, 4), sample), 0.97 * modulus(disordered(4, 4), without(sample)));
  set_polymer_content(sample, 0.023);
  EXPECT_NEAR(modulus(disordered(4, 4), sample) / modulus(disordered(4, 4), without(sample)), 1.0, 1e-9);
}

}  // namespace
}  // namespace pendular::effects::test
