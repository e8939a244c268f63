#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "diagnosis/experiment/specimens.h"
#include "packing/bridges.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::diagnosis {
namespace {

constexpr double um = 1e-6, kDiameter = 200 * um, kNeck = 70 * um;

/// Beads of a cubic lattice that nearly touch.
std::vector<Bead> lattice() {
  std::vector<Bead> beads;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) {
        Bead bead;
        bead.id = static_cast<std::int64_t>(beads.size()) + 1;
        bead.centre = Vec3(x, y, z) * 1.01 * kDiameter;
        bead.diameter = kDiameter;
        beads.push_back(bead);
      }
  return beads;
}

class MeasuredNetwork : public testing::Test {
 protected:
  MeasuredNetwork() {
    const auto beads = lattice();
    const Specimen held = specimen_enclosing(beads);
    condition_.sample.beads.diameter = kDiameter;
    condition_.sample.specimen.diameter = held.diameter;
    condition_.sample.specimen.height = held.height;
    condition_.sample.beads.diameters = Diameters::measured;
    condition_.beads = folder_.path() / "beads.csv";
    condition_.network = folder_.path() / "bridges.csv";
    write_beads(condition_.beads, beads, {});
    measured_ = candidate_bridges(beads, condition_.sample.bridges.cutoff * kDiameter);
    // A third of the pairs has no bridge, of a third it is not known.
    for (std::size_t k = 0; k < measured_.size(); ++k) {
      measured_[k].state = k % 3 == 0   ? BridgeState::none
                           : k % 3 == 1 ? BridgeState::bridge
                                        : BridgeState::undetermined;
      if (measured_[k].state != BridgeState::bridge) continue;
      measured_[k].diameter = kNeck + static_cast<double>(k) * 0.1 * um;
      measured_[k].sigma_diameter = 1 * um;
    }
    write_bridges(condition_.network, beads, measured_, {});
  }

  Packing simulated(int member) const {
    return read_packing(
        MemberPackings(folder_.path() / "members").of(condition_, member, condition_.sample).file);
  }

  TemporaryFolder folder_;
  Condition condition_;
  std::vector<Bridge> measured_;
};

TEST_F(MeasuredNetwork, IsSimulatedAsItIs) {
  const Packing packing = simulated(1);
  ASSERT_EQ(packing.bridges.size(), measured_.size());
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    const Bridge &found = packing.bridges[k], &seen = measured_[k];
    ASSERT_EQ(std::pair(found.i, found.j), std::pair(seen.i, seen.j));
    EXPECT_EQ(found.state, seen.state == BridgeState::undetermined ? BridgeState::candidate : seen.state);
    EXPECT_NEAR(found.diameter, seen.diameter, 1e-3 * um);
  }
}

TEST_F(MeasuredNetwork, NecksOfOtherMembersAreOffByTheirErrors) {
  const Packing packing = simulated(5);
  double square = 0.0, count = 0.0;
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    if (measured_[k].state != BridgeState::bridge) continue;
    square +=
        std::pow((packing.bridges[k].diameter - measured_[k].diameter) / measured_[k].sigma_diameter, 2);
    count += 1.0;
  }
  // χ² over its degrees of freedom, within four of its standard deviations.
  EXPECT_NEAR(square / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST_F(MeasuredNetwork, WithoutItAllNearPairsAreCandidates) {
  condition_.network.clear();
  for (const auto& bridge : simulated(1).bridges) EXPECT_EQ(bridge.state, BridgeState::candidate);
}

}  // namespace
}  // namespace pendular::diagnosis
