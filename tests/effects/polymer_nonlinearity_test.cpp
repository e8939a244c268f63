#include "tests.h"

#include "effects/list.h"

namespace pendular::effects::test {
namespace {

/// A bond of the paper's stiffness at a strain, without shear.
struct OneBond {
  dem_core::PairProperties properties;
  dem_core::PairHistory history = {};
  double memory[4] = {0.0, 0.0, 0.0, 0.0};
  OneBond() { properties.kn = 5760.0, properties.kt = 325.0, properties.break_limit = 1.5e-10; }
  dem_core::BondMoment at(double strain) {
    return {strain * 16e-6, 0.0, 16e-6, 1e-3, Vec3(0.0, 0.0, 1.0), properties, history, memory};
  }
};

TEST(PolymerNonlinearity, TangentStiffnessFallsByThetaPerStrainAndComesBack) {
  const auto change = find_effect("polymer_nonlinearity", "test").evolution({}, 2.0);
  OneBond bond;
  const auto force = [&](double strain) {
    change(bond.at(strain));
    return bond.properties.kn * strain * 16e-6;
  };
  for (const double strain : {0.05, 0.1, 0.2, -0.1, 0.1}) {
    const double magnitude = std::fabs(strain), h = 1e-6;
    const double tangent = (force(magnitude + h) - force(magnitude - h)) / (2.0 * h * 16e-6);
    EXPECT_NEAR(tangent, 5760.0 * (1.0 - 2.0 * magnitude), 1e-3);
  }
  force(0.0);
  EXPECT_NEAR(bond.properties.kn, 5760.0, 1e-9);
  force(5.0);
  EXPECT_NEAR(bond.properties.kn, 0.05 * 5760.0, 1e-9);
}

TEST(PolymerNonlinearity, SoftensChainsAsTheirLawSays) {
  Sample sample = with("polymer_nonlinearity", 2.0, 0.02);
  sample.compression.relax_to = 1e-6;
  const auto done = run(chains(), sample);
  const dem_core::Simulation s = actual_simulation(actual_specimen(chains(), sample, 1));
  const double height = s.bonds[0].height, section = s.section;
  // Bonds of a chain carry the same: u_total = 2 F/57600 + 5 u with F = kn u (1 − θ u/(2 l)). Each increment
  // ends with the stiffness of its own first equilibrium, so the law is met up to the last increment's share.
  for (const auto& row : done.rows) {
    double u = 0.0;
    for (int k = 0; k < 50; ++k) {
      const double force = 5760.0 * u * (1.0 - u / height);
      u = (row.strain * s.initial_height - 2.0 * force / 57600.0) / 5.0;
    }
    const double force = 9.0 * 5760.0 * u * (1.0 - u / height);
    EXPECT_NEAR(row.stress * section, force, 0.01 * force + 1e-4) << row.strain;
  }
  EXPECT_LT(std::fabs(work_error(done)), 1e-3);
  EXPECT_LT(secant(done), 0.9 * secant(run(chains(), without(sample))));
}

}  // namespace
}  // namespace pendular::effects::test
