#include "tests.h"

#include "effects/list.h"

namespace pendular::effects::test {
namespace {

TEST(BondDamage, StiffnessFallsLinearlyOverTheLastShareOfLifeAndStaysLost) {
  const double theta = 0.6, limit = 1.5e-10;
  const auto change = find_effect("bond_damage", "test").evolution({}, theta);
  PairProperties bond;
  bond.kn = 5760.0, bond.kt = 325.0, bond.break_limit = limit;
  PairHistory history = {};
  double memory = 0.0;
  const auto share_at = [&](double life) {
    change({life * std::sqrt(limit), 0.0, 16e-6, 1e-3, Vec3(0.0, 0.0, 1.0), bond, history, &memory});
    return bond.kn / 5760.0;
  };
  EXPECT_NEAR(share_at(0.3), 1.0, 1e-12);
  EXPECT_NEAR(share_at(0.4), 1.0, 1e-12);
  EXPECT_NEAR(share_at(0.7), 1.0 - 0.9 * 0.5, 1e-12);
  EXPECT_NEAR(share_at(0.1), 1.0 - 0.9 * 0.5, 1e-12);
  EXPECT_NEAR(share_at(1.0), 0.1, 1e-12);
  EXPECT_NEAR(bond.kt / 325.0, 0.1, 1e-12);
}

TEST(BondDamage, LowersThePeakAndBalancesWork) {
  const Sample sample = with("bond_damage", 0.8, 0.06);
  const auto done = run(disordered(4, 4), sample);
  EXPECT_LT(peak(done), 0.95 * peak(run(disordered(4, 4), without(sample))));
  EXPECT_LT(std::fabs(work_error(done)), 2e-3);
}

TEST(BondDamage, AChainUnloadsStraightToTheOrigin) {
  Sample sample = with("bond_damage", 1.0, 0.015);
  sample.compression.control = "speed";
  sample.compression.rows_per_strain = 1e4;
  sample.compression.unload_at = {0.014};
  const auto rows = run(chains(), sample).rows;
  std::size_t turn = 0;
  while (turn + 1 < rows.size() && rows[turn + 1].strain > rows[turn].strain) ++turn;
  ASSERT_GT(turn, 100u);
  ASSERT_LT(turn + 40, rows.size());
  const auto slope = [&](std::size_t a, std::size_t b) {
    return (rows[b].stress - rows[a].stress) / (rows[b].strain - rows[a].strain);
  };
  const double secant = rows[turn].stress / rows[turn].strain;
  EXPECT_NEAR(slope(turn + 40, turn), secant, 0.05 * secant);
  EXPECT_LT(slope(turn - 40, turn), 0.8 * secant);
}

}  // namespace
}  // namespace pendular::effects::test
