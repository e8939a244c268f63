#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(PlatenTilt, IsAPlaneThatTouchesTheHighestBead) {
  const dem_core::Simulation s = actual_simulation(actual_specimen(chains(), with("platen_tilt", 1.0), 1));
  const dem_core::Simulation flat = dem_core::build_simulation(chains(), with("platen_tilt", 1.0));
  double nearest = 1.0;
  for (std::size_t k = 0; k < s.beads.size(); ++k) {
    nearest = std::min(nearest, s.top.gap(k, s.beads.position[k].z(), s.beads.radius[k]));
    EXPECT_NEAR(s.top.relief[k] - s.top.relief[0],
                std::tan(M_PI / 180.0) * (s.beads.position[k].x() - s.beads.position[0].x()), 1e-15);
  }
  EXPECT_NEAR(nearest, 0.0, 1e-15);
  EXPECT_EQ(s.bottom.z, flat.bottom.z);
}

TEST(PlatenTilt, ChainsTouchOneRowAfterTheOther) {
  // Three rows along x, each a slope times the pitch later than the one before: forces add up as they touch.
  Sample sample = with("platen_tilt", 0.05, 1e-3);
  sample.compression.relax_to = 1e-5;
  const auto done = run(chains(), sample);
  const double k = chain_stiffness(5760.0), pitch = (1.0 + kGap) * kBeadDiameter;
  const double height = (5.0 * (1.0 + kGap) + 1.0) * kBeadDiameter,
               step = std::tan(0.05 * M_PI / 180.0) * pitch;
  const double section = 0.25 * M_PI * std::pow(sample.specimen.diameter, 2);
  for (const auto& row : done.rows) {
    const double travel = row.strain * done.result["specimen"]["height_um"].get<double>() * 1e-6;
    double force = 0.0;
    for (int n = 0; n < 3; ++n) force += 3.0 * k * std::max(0.0, travel - n * step);
    EXPECT_NEAR(row.stress * section, force, 1e-3 * 9.0 * k * height * 2e-3) << row.strain;
  }
  EXPECT_LT(done.rows.back().stress, 0.95 * run(chains(), without(sample)).rows.back().stress);
}

}  // namespace
}  // namespace pendular::effects::test
