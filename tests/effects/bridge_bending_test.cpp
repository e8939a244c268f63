#include "tests.h"

#include "micromechanics/stiffness.h"

namespace pendular::effects::test {
namespace {

TEST(BridgeBending, IsTheFiniteElementOneTimesTheta) {
  const Sample sample = with("bridge_bending", 1.5);
  const micromechanics::BondStiffness fe = micromechanics::bridge_stiffness(
      micromechanics::mean_bridge(sample), micromechanics::polymer_of(sample));
  const dem_core::Simulation simulation = actual_simulation(actual_specimen(chains(), sample, 1));
  EXPECT_TRUE(simulation.law.bending);
  const dem_core::PairProperties& bond = simulation.pairs.front().properties;
  EXPECT_NEAR(bond.k_bend, 1.5 * fe.bending, 1e-3 * fe.bending);
  EXPECT_NEAR(bond.k_twist, 1.5 * fe.twisting, 1e-3 * fe.twisting);
  EXPECT_EQ(bond.kn, 5760.0);
  // A disc of incompressible polymer, thin against its width, under a moment: of a bar it would be kn d²/16.
  EXPECT_GT(fe.bending, 0.2 * fe.normal * std::pow(73.9e-6, 2) / 16.0);
  EXPECT_LT(fe.bending, fe.normal * std::pow(73.9e-6, 2) / 16.0);
}

TEST(BridgeBending, RaisesTheModulus) {
  const Sample sample = with("bridge_bending", 2.0, 0.02);
  EXPECT_GT(modulus(disordered(4, 4), sample), modulus(disordered(4, 4), without(sample)));
  EXPECT_GT(secant(run(disordered(3, 4), sample)), secant(run(disordered(3, 4), without(sample))));
}

}  // namespace
}  // namespace pendular::effects::test
