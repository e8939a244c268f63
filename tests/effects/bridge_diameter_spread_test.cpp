#include "tests.h"

#include "micromechanics/stiffness.h"

namespace pendular::effects::test {
namespace {

TEST(BridgeDiameterSpread, BondsHaveTheStiffnessOfTheirNecks) {
  const Sample sample = with("bridge_diameter_spread", 12.7);
  const auto specimen = actual_specimen(disordered(4, 4), sample, 1);
  const dem_core::Simulation simulation = actual_simulation(specimen);
  const micromechanics::Polymer polymer = micromechanics::polymer_of(sample);
  const double stated =
      micromechanics::bridge_stiffness(micromechanics::mean_bridge(sample), polymer).tangential;
  double mean = 0.0, square = 0.0;
  for (const auto& body : specimen.bodies)
    mean += body.neck_diameter, square += std::pow(body.neck_diameter, 2);
  const double n = static_cast<double>(specimen.bodies.size());
  mean /= n;
  const double sd = std::sqrt(square / n - mean * mean);
  EXPECT_NEAR(mean, 73.9e-6, 4.0 * 12.7e-6 / std::sqrt(n));
  EXPECT_NEAR(sd, 12.7e-6, 4.0 * 12.7e-6 / std::sqrt(2.0 * n));
  for (std::size_t p = 0; p < simulation.pairs.size(); p += 50) {
    const auto& pair = simulation.pairs[p];
    if (pair.bond < 0) continue;
    const double kt = 325.0 * bridge_stiffness(specimen.bodies[pair.bond], polymer).tangential / stated;
    EXPECT_NEAR(pair.properties.kt, kt, 2e-3 * kt);
  }
}

TEST(BridgeDiameterSpread, LowersTheModulus) {
  const Sample sample = with("bridge_diameter_spread", 40.0);
  EXPECT_LT(modulus(disordered(4, 4), sample), 0.99 * modulus(disordered(4, 4), without(sample)));
}

}  // namespace
}  // namespace pendular::effects::test
