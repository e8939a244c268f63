#include "tests.h"

#include "effects/list.h"

namespace pendular::effects::test {
namespace {

TEST(BondDamage, StiffnessFallsLinearlyOverTheLastShareOfLifeAndStaysLost) {
  const double theta = 0.6, limit = 1.5e-10;
  const auto change = find_effect("bond_damage", "test").evolution({}, theta);
  dem_core::PairProperties bond;
  bond.kn = 5760.0, bond.kt = 325.0, bond.break_limit = limit;
  dem_core::PairHistory history = {};
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

}  // namespace
}  // namespace pendular::effects::test
