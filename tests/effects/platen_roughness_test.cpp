#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(PlatenRoughness, HasTheRootMeanSquareStatedAndTouches) {
  const dem_core::Simulation s =
      actual_simulation(actual_specimen(disordered(5, 5), with("platen_roughness", 10.0), 1));
  for (const dem_core::Platen* platen : {&s.bottom, &s.top}) {
    double square = 0.0, nearest = 1.0;
    for (std::size_t k = 0; k < s.beads.size(); ++k) {
      square += platen->relief[k] * platen->relief[k];
      EXPECT_GE(platen->relief[k], 0.0);
      nearest = std::min(nearest, platen->gap(k, s.beads.position[k].z(), s.beads.radius[k]));
    }
    EXPECT_NEAR(std::sqrt(square / static_cast<double>(s.beads.size())), 10e-6, 1.3e-6);
    EXPECT_NEAR(nearest, 0.0, 1e-15);
  }
}

TEST(PlatenRoughness, ChainsTouchOneAfterTheOther) {
  const Sample sample = with("platen_roughness", 1.0, 5e-3);
  const dem_core::Simulation s = actual_simulation(actual_specimen(chains(), sample, 1));
  const auto done = run(chains(), sample);
  const double k = chain_stiffness(5760.0);
  for (const auto& row : done.rows) {
    double force = 0.0;
    for (std::size_t b = 0; b < 9; ++b) {
      const std::size_t t = b + 45;
      const double open = s.bottom.gap(b, s.beads.position[b].z(), s.beads.radius[b]) +
                          s.top.gap(t, s.beads.position[t].z(), s.beads.radius[t]);
      force += k * std::max(0.0, row.strain * s.initial_height - open);
    }
    EXPECT_NEAR(row.stress * s.section, force, 2e-3 * 9.0 * k * s.initial_height * 5e-3) << row.strain;
  }
}

}  // namespace
}  // namespace pendular::effects::test
