#include "tests.h"

#include "dem_core/observe/quasi_static.h"
#include "dem_core/step/forces.h"

namespace pendular::effects::test {
namespace {

TEST(ResidualStress, AFreeBondComesToItsShorterLength) {
  const dem_core::Simulation simulation =
      actual_simulation(actual_specimen(columns(1, 2, kGap), with("residual_stress", 0.1), 1));
  const double height = simulation.bonds[0].height;
  EXPECT_NEAR(gap(simulation, simulation.pairs[0]), kGap * kBeadDiameter - 0.1 * height, 1e-3 * height);
  EXPECT_NEAR(simulation.initial_height, (2.0 + kGap) * kBeadDiameter - 0.1 * height, 1e-3 * height);
  EXPECT_NEAR(simulation.work.given, 0.0, 1e-4 * 0.5 * 5760.0 * std::pow(0.1 * height, 2));
}

TEST(ResidualStress, ABondAcrossTouchingBeadsPressesThemTogether) {
  const dem_core::Simulation simulation =
      actual_simulation(actual_specimen(columns(1, 2, 0.0), with("residual_stress", 0.1), 1));
  // The law's bond keeps its force in overlap, against k_glass.
  const double height = simulation.bonds[0].height;
  EXPECT_NEAR(gap(simulation, simulation.pairs[0]), -5760.0 / 57600.0 * 0.1 * height, 1e-3 * height);
}

TEST(ResidualStress, ADisorderedSpecimenIsAtRestUnderItAndStiffer) {
  Sample sample = with("residual_stress", 0.15, 0.02);
  const dem_core::Simulation simulation = actual_simulation(actual_specimen(disordered(4, 4), sample, 1));
  // Over fewer forces than in the settling: the platens touch now, and carry nothing.
  EXPECT_LE(dem_core::unbalanced_force(simulation, forces(simulation)), 1.2 * sample.compression.relax_to);
  EXPECT_GT(simulation.work.given, 0.0);
  EXPECT_EQ(simulation.steps, 0);
  const auto stressed = run(disordered(4, 4), sample), plain = run(disordered(4, 4), without(sample));
  EXPECT_GT(secant(stressed), secant(plain));
  EXPECT_LT(std::fabs(work_error(stressed)), 1e-3);
}

}  // namespace
}  // namespace pendular::effects::test
