#include "tests.h"

#include "micromechanics/stiffness.h"

namespace pendular::effects::test {
namespace {

TEST(BridgeGapSpread, ChainsAreSpringsInSeriesOfTheirGaps) {
  const Sample sample = with("bridge_gap_spread", 3.0, 1e-3);
  const auto specimen = actual_specimen(chains(), sample, 1);
  const dem_core::Simulation simulation = actual_simulation(specimen);
  const micromechanics::Polymer polymer = micromechanics::polymer_of(sample);
  const double stated = micromechanics::bridge_stiffness(micromechanics::mean_bridge(sample), polymer).normal;
  double mean = 0.0;
  std::vector<double> soft(9, 2.0 / 57600.0);
  for (std::size_t k = 0; k < specimen.bodies.size(); ++k) {
    const double kn = 5760.0 * bridge_stiffness(specimen.bodies[k], polymer).normal / stated;
    soft[static_cast<std::size_t>(simulation.bonds[k].i) % 9] += 1.0 / kn;
    mean += (specimen.bodies[k].gap - 2e-6) / 45.0;
    // A longer bridge breaks later: by its height, which is the pair's own gap and the excess.
    const auto& bond = simulation.bonds[k];
    EXPECT_NEAR(bond.height,
                micromechanics::rim_height(kGap * kBeadDiameter + specimen.bodies[k].gap - 2e-6,
                                           kBeadDiameter, kBeadDiameter, 73.9e-6),
                1e-12);
  }
  double sum = 0.0;
  for (const double one : soft) sum += 1.0 / one;
  EXPECT_NEAR(mean, 3e-6, 3.0 * 3e-6 / std::sqrt(45.0));
  const double expected = sum * simulation.initial_height / simulation.section;
  EXPECT_NEAR(modulus(chains(), sample, 1e-3), expected, 1e-3 * expected);
  EXPECT_LT(expected, 0.7 * modulus(chains(), without(sample), 1e-3));
}

TEST(BridgeGapSpread, LeavesTheBridgesThatAre) {
  const Sample sample = with("bridge_gap_spread", 3.0);
  EXPECT_EQ(actual_simulation(actual_specimen(disordered(4, 4), sample, 1)).bonds.size(),
            dem_core::build_simulation(disordered(4, 4), sample).bonds.size());
}

}  // namespace
}  // namespace pendular::effects::test
