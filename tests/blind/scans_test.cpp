#include "blind/scans.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/kinds/similarity.h"
#include "packing/statistics.h"
#include "scratch.h"
#include "small_split.h"
#include "specimens.h"

namespace pendular::blind {
namespace {

using pendular::test::ScratchFolder;

constexpr double um = 1e-6;

/// Chains of beads between the platens, or a disordered specimen, that was compressed and scanned.
struct Scanned {
  explicit Scanned(const Packing& packing_, CasePlan plan_ = {}) : plan(std::move(plan_)), packing(packing_) {
    split.sample.compression.speed = 2e-4;
    split.sample.bridges.normal_stiffness = 5760.0, split.sample.bridges.tangential_stiffness = 325.0;
    split.sample.beads.diameters = Diameters::measured;
    split.sample.specimen.diameter = packing.specimen.diameter,
    split.sample.specimen.height = packing.specimen.height;
    plan.seed = 17;
  }
  void test(double strain, const ScratchFolder& folder) {
    split.max_strain = 1.2 * strain;
    truth = run_truth(plan, split, split.sample, packing, 0, false, strain, folder / "run");
  }
  ScannedSpecimen specimen() const { return {plan, split, packing, packing.beads, truth}; }

  Split split = test::small_split();
  CasePlan plan;
  Packing packing;
  TrueTest truth;
};

Packing chains() {
  Packing packing = pendular::test::columns(3, 6, 0.03);
  std::erase_if(packing.bridges, [](const Bridge& bridge) { return bridge.i % 9 != bridge.j % 9; });
  packing.specimen = specimen_enclosing(packing.beads);
  return packing;
}

Packing specimen_of(int side, int tall) {
  Packing packing = pendular::test::disordered(side, tall);
  packing.specimen = specimen_enclosing(packing.beads);
  return packing;
}

/// How far the flat ends have come nearer, over the specimen's height.
double shortening(const Scanned& of) {
  double low = 0.0, high = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    low += of.truth.scan.displacement[k].z() / 9.0;
    high += of.truth.scan.displacement[45 + k].z() / 9.0;
  }
  return std::fabs(high - low) / of.packing.specimen.height;
}

double strain_share_of_bonds() {
  // Five bonds of 5,760 N/m and two contacts with the platens of 57,600 N/m one after the other.
  return 5.0 / 5760.0 / (5.0 / 5760.0 + 2.0 / 57600.0);
}

TEST(Scans, AreOfTheSpecimenAtTheStatedStrain) {
  ScratchFolder folder;
  Scanned chain(chains());
  chain.test(0.01, folder);
  EXPECT_NEAR(shortening(chain), 0.01 * strain_share_of_bonds(), 0.02 * 0.01);
}

TEST(Scans, WhereAnInstrumentMisreadsTheStrainTheyAreWhereItReadsTheStatedOne) {
  ScratchFolder folder;
  CasePlan plan;
  plan.effects = {{"machine_compliance", 10.0}};  // um/N: the specimen is strained less than is read
  Scanned chain(chains(), plan);
  chain.test(0.01, folder);
  // Nine chains; the machine gives way in series with them.
  const double stiffness = 9.0 / (5.0 / 5760.0 + 2.0 / 57600.0), machine = 1.0 / 10e-6;
  EXPECT_NEAR(shortening(chain), 0.01 * strain_share_of_bonds() * machine / (machine + stiffness),
              0.04 * 0.01);
}

/// Column of a table by its name.
std::vector<double> column(const Table& table, const std::string& name) {
  const auto at =
      static_cast<std::size_t>(std::find(table.names.begin(), table.names.end(), name) - table.names.begin());
  std::vector<double> values;
  for (const auto& row : table.rows) values.push_back(row[at]);
  return values;
}

TEST(Scans, FollowedBeadsMovedAsTheyDidButForNoiseAndHowTheSpecimenLies) {
  ScratchFolder folder;
  Scanned specimen(specimen_of(4, 5));
  specimen.test(0.01, folder);
  nlohmann::ordered_json told;
  const Table table = followed_beads(specimen.specimen(), 0.01, told);
  // One in a hundred is lost.
  const double beads = static_cast<double>(specimen.packing.beads.size());
  EXPECT_LT(table.rows.size(), specimen.packing.beads.size() + 1);
  EXPECT_NEAR(static_cast<double>(table.rows.size()), 0.99 * beads, 4.0 * std::sqrt(0.01 * beads));
  for (const double strain : column(table, "strain")) EXPECT_EQ(strain, 0.01);

  std::map<std::int64_t, Vec3> truth;
  for (std::size_t k = 0; k < specimen.packing.beads.size(); ++k)
    truth[specimen.packing.beads[k].id] = specimen.truth.scan.displacement[k];
  std::vector<Vec3> rest, seen, was;
  const auto ids = column(table, "bead_id");
  for (std::size_t k = 0; k < ids.size(); ++k) {
    rest.emplace_back(um * column(table, "x_um")[k], um * column(table, "y_um")[k],
                      um * column(table, "z_um")[k]);
    seen.emplace_back(um * column(table, "ux_um")[k], um * column(table, "uy_um")[k],
                      um * column(table, "uz_um")[k]);
    was.push_back(truth.at(static_cast<std::int64_t>(ids[k])));
  }
  const auto left = diagnosis::without_rigid_motion(rest, seen),
             expected = diagnosis::without_rigid_motion(rest, was);
  double square = 0.0, motion = 0.0, lying = 0.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    square += (left[k] - expected[k]).squaredNorm() / (3.0 * static_cast<double>(left.size()));
    motion += expected[k].squaredNorm() / (3.0 * static_cast<double>(left.size()));
    lying = std::max(lying, seen[k].norm());
  }
  // The beads of the first scan are given as they are: the noise is the second scan's.
  EXPECT_NEAR(std::sqrt(square), specimen.split.sigma_centre, 0.1 * specimen.split.sigma_centre);
  EXPECT_GT(std::sqrt(motion), 5.0 * specimen.split.sigma_centre);
  EXPECT_GT(lying, 100.0 * um);  // it was turned about its axis
  const double stated = told["displacements"]["stated_over_true_sigma"];
  EXPECT_GE(stated, 0.7);
  EXPECT_LE(stated, 1.3);
  EXPECT_NEAR(column(table, "sigma_um").front(), stated * std::sqrt(2.0) * specimen.split.sigma_centre / um,
              1e-12);
  EXPECT_NEAR(told["displacements"]["scale"].get<double>(), 1.0, 0.005);
}

TEST(Scans, NetworksAreMeasuredWithTheStatedErrors) {
  Scanned specimen(specimen_of(6, 7));
  specimen.truth.packing = specimen.packing;
  specimen.truth.sample = specimen.split.sample;
  specimen.truth.sample.bridges.diameter_sd = 0.0;
  // Every third pair has no bridge.
  std::set<std::pair<int, int>> standing;
  for (std::size_t k = 0; k < specimen.packing.bridges.size(); ++k)
    if (k % 3) standing.insert({specimen.packing.bridges[k].i, specimen.packing.bridges[k].j});
  for (std::size_t k = 0; k < specimen.packing.bridges.size(); ++k)
    specimen.truth.bodies.push_back({60e-6, 2e-6, 200e-6, 200e-6});
  nlohmann::ordered_json told;
  const auto bridges = measured_bridges(specimen.specimen(), "bridges_rest", standing, told);
  double undetermined = 0.0, mistaken = 0.0, square = 0.0, necks = 0.0;
  for (const auto& bridge : bridges) {
    const bool stands = standing.contains({bridge.i, bridge.j}), seen = bridge.state == BridgeState::bridge;
    undetermined += bridge.state == BridgeState::undetermined;
    mistaken += bridge.state != BridgeState::undetermined && seen != stands;
    if (!seen || !stands) continue;
    square += std::pow(bridge.diameter / 60e-6 - 1.0, 2), necks += 1.0;
  }
  const double pairs = static_cast<double>(bridges.size());
  ASSERT_GT(pairs, 2000.0);
  EXPECT_NEAR(undetermined / pairs, 0.02, 4.0 * std::sqrt(0.02 / pairs));
  EXPECT_NEAR(mistaken / pairs, 0.005, 4.0 * std::sqrt(0.005 / pairs));
  EXPECT_NEAR(std::sqrt(square / necks), 0.02, 0.003);
  // Necks that differ without any effect do so in every scan.
  specimen.truth.sample.bridges.diameter_sd = 6e-6;
  const auto rest = measured_bridges(specimen.specimen(), "bridges_rest", standing, told),
             load = measured_bridges(specimen.specimen(), "bridges_load", standing, told);
  double of_one = 0.0, of_both = 0.0, pairs_of_necks = 0.0;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (rest[k].state != BridgeState::bridge || load[k].state != BridgeState::bridge) continue;
    const double at_rest = rest[k].diameter / 60e-6 - 1.0, at_load = load[k].diameter / 60e-6 - 1.0;
    of_one += at_rest * at_rest, of_both += at_rest * at_load, pairs_of_necks += 1.0;
  }
  EXPECT_NEAR(std::sqrt(of_one / pairs_of_necks), std::hypot(0.1, 0.02), 0.006);
  EXPECT_NEAR(std::sqrt(of_both / pairs_of_necks), 0.1, 0.006);
  // Another scan of it is mistaken elsewhere.
  const auto again = measured_bridges(specimen.specimen(), "bridges_load", standing, told);
  EXPECT_TRUE(std::any_of(bridges.begin(), bridges.end(), [&](const Bridge& bridge) {
    return bridge.state != again[static_cast<std::size_t>(&bridge - bridges.data())].state;
  }));
}

}  // namespace
}  // namespace pendular::blind
