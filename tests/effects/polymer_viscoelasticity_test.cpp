#include "tests.h"

#include "effects/list.h"

namespace pendular::effects::test {
namespace {

TEST(PolymerViscoelasticity, AHeldBondRelaxesAsTheStandardLinearSolid) {
  const double theta = 0.4;
  ActualSpecimen specimen;
  const Sample& sample = specimen.believed = with("polymer_viscoelasticity", theta);
  const double time = 0.01 * sample.specimen.height / dem_core::platen_speed(sample);
  const auto change = find_effect("polymer_viscoelasticity", "test").evolution(specimen, theta);
  dem_core::PairProperties bond;
  bond.kn = 5760.0, bond.kt = 325.0;
  dem_core::PairHistory history = {};
  history.bond_slip = {2e-6, 0.0, 0.0};
  double memory[4] = {0.0, 0.0, 0.0, 0.0};
  const double gap = 3e-6, dt = 0.1 * time;
  for (int k = 1; k <= 40; ++k) {
    const double shear = length(history.bond_slip);
    change({gap - bond.rest, shear, 16e-6, dt, Vec3(0.0, 0.0, 1.0), bond, history, memory});
    const double left = 1.0 - theta * (1.0 - std::exp(-0.1 * k));
    EXPECT_NEAR(gap - bond.rest, left * 3e-6, 1e-15);
    EXPECT_NEAR(history.bond_slip.x, left * 2e-6, 1e-15);
  }
  EXPECT_EQ(bond.kn, 5760.0);
}

/// Sample A driven fast, and then held for five relaxation times.
Sample held(double theta) {
  Sample sample = with("polymer_viscoelasticity", theta, 2e-3);
  sample.compression.control = Control::speed;
  sample.compression.rows_per_strain = 1e4;
  sample.compression.hold_at = {2e-3};
  sample.compression.hold = 0.05;
  sample.specimen.height = (5.0 * (1.0 + kGap) + 1.0) * kBeadDiameter;
  return sample;
}

TEST(PolymerViscoelasticity, AHeldChainLosesWhatItsBondsRelax) {
  const double theta = 0.5;
  const auto done = run(chains(), held(theta));
  // Long after, a bond has (1 − θ) of its stiffness; the glass on the platens keeps its own.
  const dem_core::Simulation s = dem_core::build_simulation(chains(), held(theta));
  const double travel = done.result["final_strain"].get<double>() * s.initial_height;
  const double relaxed = 9.0 * chain_stiffness((1.0 - theta) * 5760.0) * travel / s.section;
  EXPECT_NEAR(done.rows.back().stress, relaxed, 0.01 * relaxed);
  // Driven so fast and so shortly, the balance of the elastic chains misses by as much.
  EXPECT_LT(std::fabs(work_error(done)), 2e-3);
}

TEST(PolymerViscoelasticity, LowersTheModulus) {
  const Sample sample = with("polymer_viscoelasticity", 0.5, 0.02);
  const auto done = run(disordered(3, 4), sample);
  EXPECT_LT(secant(done), secant(run(disordered(3, 4), without(sample))));
  EXPECT_LT(std::fabs(work_error(done)), 2e-3);
}

}  // namespace
}  // namespace pendular::effects::test
