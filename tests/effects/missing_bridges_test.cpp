#include "tests.h"

#include <algorithm>
#include <set>

namespace pendular::effects::test {
namespace {

std::set<std::pair<int, int>> missing(double theta) {
  std::set<std::pair<int, int>> gone;
  for (const auto& bridge :
       actual_specimen(disordered(5, 5), with("missing_bridges", theta), 3).packing.bridges)
    if (bridge.state == BridgeState::none) gone.insert({bridge.i, bridge.j});
  return gone;
}

TEST(MissingBridges, AreTheShareAskedForAndNested) {
  const auto few = missing(0.1), many = missing(0.2);
  const double all = static_cast<double>(disordered(5, 5).bridges.size());
  EXPECT_NEAR(static_cast<double>(few.size()) / all, 0.1, 4.0 * std::sqrt(0.09 / all));
  EXPECT_NEAR(static_cast<double>(many.size()) / all, 0.2, 4.0 * std::sqrt(0.16 / all));
  EXPECT_TRUE(std::includes(many.begin(), many.end(), few.begin(), few.end()));
}

TEST(MissingBridges, LeaveWholeChainsOnly) {
  const Sample sample = with("missing_bridges", 0.1, 1e-3);
  const auto specimen = actual_specimen(chains(), sample, 4);
  std::set<int> broken;
  for (const auto& bridge : specimen.packing.bridges)
    if (bridge.state == BridgeState::none) broken.insert(bridge.i % 9);
  ASSERT_GT(broken.size(), 0u);
  ASSERT_LT(broken.size(), 9u);
  const auto done = run(chains(), sample, 4);
  const dem_core::Simulation built = actual_simulation(specimen);
  // Chains of a height of six diameters: what is cut rests on its platen, and does not reach the other half.
  const double whole = static_cast<double>(9 - broken.size());
  const double expected = whole * chain_stiffness(5760.0) * built.initial_height / built.section;
  EXPECT_NEAR(secant(done), expected, 5e-3 * expected);
}

TEST(MissingBridges, MeasuredOnesStay) {
  Packing measured = disordered(4, 4);
  for (auto& bridge : measured.bridges) bridge.state = BridgeState::bridge;
  const auto specimen = actual_specimen(measured, with("missing_bridges", 0.5), 1);
  for (const auto& bridge : specimen.packing.bridges) EXPECT_EQ(bridge.state, BridgeState::bridge);
}

TEST(MissingBridges, LowerModulusCoordinationAndPeak) {
  const Sample sample = with("missing_bridges", 0.2, 0.06);
  const auto full = run(disordered(4, 4), without(sample)), thinned = run(disordered(4, 4), sample);
  EXPECT_LT(modulus(disordered(4, 4), sample), 0.97 * modulus(disordered(4, 4), without(sample)));
  EXPECT_NEAR(thinned.rows.front().coordination, 0.8 * full.rows.front().coordination,
              0.06 * full.rows.front().coordination);
  EXPECT_LT(peak(thinned), peak(full));
}

}  // namespace
}  // namespace pendular::effects::test
