#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(InterfaceStrength, HasTheMeanAndTheSpreadStated) {
  const Sample sample = with("interface_strength", 0.4);
  const dem_core::Simulation believed = dem_core::build_simulation(disordered(5, 5), sample);
  const dem_core::Simulation actual = actual_simulation(actual_specimen(disordered(5, 5), sample, 1));
  double mean = 0.0, square = 0.0, n = 0.0;
  for (std::size_t p = 0; p < believed.pairs.size(); ++p) {
    if (believed.pairs[p].bond < 0) continue;
    const double ratio = actual.pairs[p].properties.break_limit / believed.pairs[p].properties.break_limit;
    mean += ratio, square += std::log(ratio) * std::log(ratio), n += 1.0;
  }
  mean /= n;
  const double shift = std::log(1.4) - 0.02;
  EXPECT_NEAR(mean, 1.4, 4.0 * 0.29 / std::sqrt(n));
  EXPECT_NEAR(square / n, 0.04 + shift * shift, 0.02);
}

TEST(InterfaceStrength, MovesBreakingAndNotTheModulus) {
  const Packing packing = disordered(4, 4);
  const Sample weak = with("interface_strength", -0.5, 0.06), strong = with("interface_strength", 0.5, 0.06);
  const auto believed = run(packing, without(weak)), early = run(packing, weak);
  EXPECT_LT(peak(early), 0.95 * peak(believed));
  EXPECT_GT(early.rows.back().broken_bonds, believed.rows.back().broken_bonds);
  EXPECT_EQ(modulus(packing, weak), modulus(packing, strong));
}

}  // namespace
}  // namespace pendular::effects::test
