#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "base/temporary_folder.h"
#include "diagnosis/experiment/specimens.h"
#include "observations.h"
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

/// Leaves the pairs with a bridge in the table, as one that counts bridges writes it.
class ListOfBridges : public MeasuredNetwork {
 protected:
  ListOfBridges() {
    all_ = std::exchange(measured_, {});
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(measured_),
                 [](const Bridge& one) { return one.state == BridgeState::bridge; });
    write_bridges(condition_.network, lattice(), measured_, {});
    for (const Bridge& one : measured_) joined_.insert({one.i, one.j});
  }

  bool without(const Bridge& pair) const {
    return pair.state != BridgeState::bridge && joined_.contains(pair.i) && joined_.contains(pair.j);
  }

  std::vector<Bridge> all_;
  std::set<int> joined_;
};

TEST_F(ListOfBridges, OtherNearPairsOfItsBeadsAreSimulatedWithout) {
  const Packing packing = simulated(1);
  ASSERT_EQ(packing.bridges.size(), all_.size());
  int none = 0;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    EXPECT_EQ(packing.bridges[k].state, without(all_[k])                       ? BridgeState::none
                                        : all_[k].state == BridgeState::bridge ? BridgeState::bridge
                                                                               : BridgeState::candidate);
    none += without(all_[k]);
  }
  EXPECT_GT(none, 50);
}

TEST_F(ListOfBridges, OtherNearPairsOfItsBeadsAreObservedWithout) {
  Observation observation = test::observation(kinds::bridges(), "network", {});
  observation.file = condition_.network, observation.beads = condition_.beads;
  const CsvTable table = read_csv(
      condition_.network, observation.kind->required,
      {"gap_um", "sigma_gap_um", "probability", "bridge_diameter_um", "sigma_bridge_diameter_um", "state"});
  for (const auto& name : observation.kind->required) observation.columns[name] = table.numbers(name);
  for (const auto& name : observation.kind->optional) observation.columns[name] = table.numbers(name);
  observation.kind->read(observation, table);
  std::vector<std::string> warnings;
  observation.kind->check(condition_.sample, observation, warnings);
  const auto none = static_cast<std::size_t>(
      std::count_if(all_.begin(), all_.end(), [&](const Bridge& one) { return without(one); }));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(fmt::format("{} near pairs", none)), std::string::npos) << warnings[0];
  for (const auto& [name, column] : observation.columns)
    EXPECT_EQ(column.size(), measured_.size() + none) << name;
  EXPECT_NEAR(test::value(observation, "bridged_share"),
              static_cast<double>(measured_.size()) / static_cast<double>(measured_.size() + none), 1e-12);
}

TEST_F(MeasuredNetwork, WithoutItAllNearPairsAreCandidates) {
  condition_.network.clear();
  for (const auto& bridge : simulated(1).bridges) EXPECT_EQ(bridge.state, BridgeState::candidate);
}

}  // namespace
}  // namespace pendular::diagnosis
