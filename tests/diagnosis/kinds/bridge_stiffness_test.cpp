#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "micromechanics/bridge_fe.h"
#include "micromechanics/stiffness.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

Observation tested(Columns columns) {
  return observation(kinds::bridge_stiffness(), "kn", std::move(columns));
}

Columns simulated(const Observation& of, const Sample& sample) {
  return of.kind->simulate(of, {sample});
}

TEST(BridgeStiffness, FollowsTheStatedOne) {
  // The bridge that the sample states has the stiffness that it states; a thicker one is stiffer.
  const Observation two = tested({{"d_um", {73.9, 100.0}}, {"D_um", {200.9, 200.9}}});
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0, sample.bridges.tangential_stiffness = 325.0;
  const Columns columns = simulated(two, sample);
  EXPECT_NEAR(columns.at("kn_n_per_m")[0], 5760.0, 6.0);  // the table interpolates
  EXPECT_NEAR(columns.at("kt_n_per_m")[0], 325.0, 0.4);
  EXPECT_GT(columns.at("kn_n_per_m")[1], 1.1 * 5760.0);
}

TEST(BridgeStiffness, IsAModulusTimesALength) {
  // Elasticity knows no length of its own: a body twice as large of a polymer thrice as stiff is six times as
  // stiff.
  Observation small = tested({{"d_um", {60.0}}, {"D_um", {200.0}}}),
              large = tested({{"d_um", {120.0}}, {"D_um", {400.0}}});
  small.numbers["gap_um"] = 2.0, large.numbers["gap_um"] = 4.0;
  Sample sample;
  const Columns one = simulated(small, sample);
  sample.bridges.youngs_modulus *= 3.0;
  const Columns other = simulated(large, sample);
  for (const char* name : {"kn_n_per_m", "kt_n_per_m"})
    EXPECT_NEAR(other.at(name)[0] / one.at(name)[0], 6.0, 0.01) << name;
}

TEST(BridgeStiffness, BridgesFromTheSpecimenHaveItsGaps) {
  Observation made = tested({{"d_um", {74.0}}, {"D_um", {200.9}}}), cut = made;
  cut.words["origin"] = "specimen";
  Sample sample;
  for (const char* name : {"kn_n_per_m", "kt_n_per_m"})
    EXPECT_EQ(simulated(cut, sample).at(name), simulated(made, sample).at(name));
  sample.effects["bridge_gap_spread"] = 3.0;
  // The mean logarithm over an exponential excess of 3 um, here over 4,000 drawn bridges.
  std::vector<micromechanics::BridgeBody> bodies;
  for (std::uint64_t k = 0; k < 4000; ++k)
    bodies.push_back({74e-6, 2e-6 - 3e-6 * std::log(1.0 - random_uniform(3, k)), 200.9e-6, 200.9e-6});
  double mean = 0.0;
  for (const auto& bond :
       micromechanics::bridge_stiffnesses(bodies, micromechanics::polymer_of(sample)).bonds)
    mean += std::log(bond.normal) / 4000.0;
  EXPECT_NEAR(std::log(simulated(cut, sample).at("kn_n_per_m")[0]), mean, 0.03);
  EXPECT_EQ(simulated(made, sample).at("kn_n_per_m"), simulated(made, Sample{}).at("kn_n_per_m"));
}

TEST(BridgeStiffness, IsAskedForByManyThreadsAtOnce) {
  // Runs of a bank are read on all cores, and what they ask for is computed on all cores under a lock.
  constexpr std::size_t kRuns = 4, kBridges = 4;
  const std::vector<double> necks = {50.0, 60.0, 70.0, 80.0};
  const Observation table = tested({{"d_um", necks}, {"D_um", std::vector<double>(kBridges, 200.0)}});
  std::vector<Columns> found(kRuns);
  for_blocks(kRuns, 1, [&](std::size_t run, std::size_t) {
    Observation other = table;
    other.numbers["gap_um"] = 2.0 + 0.1 * static_cast<double>(run);
    found[run] = simulated(other, Sample{});
  });
  for (const std::size_t run : {std::size_t{0}, kRuns - 1})
    for (std::size_t k = 0; k < kBridges; ++k) {
      const micromechanics::BridgeBody body{1e-6 * necks[k], 1e-6 * (2.0 + 0.1 * static_cast<double>(run)),
                                            200e-6, 200e-6};
      const double expected =
          micromechanics::bridge_stiffness(body, micromechanics::polymer_of(Sample{})).normal;
      EXPECT_NEAR(found[run].at("kn_n_per_m")[k] / expected, 1.0, 1e-3);
    }
}

TEST(BridgeStiffness, LevelAndExponentOfAPowerLaw) {
  Columns columns;
  for (const double d : {40.0, 60.0, 80.0, 100.0}) {
    columns["d_um"].push_back(d), columns["D_um"].push_back(200.0);
    columns["kn_n_per_m"].push_back(3.0 * std::pow(d, 1.5)),
        columns["kn_sigma_n_per_m"].push_back(0.15 * std::pow(d, 1.5));
  }
  Observation table = tested(columns);
  EXPECT_NEAR(value(table, "kn_exponent"), 1.5, 1e-9);
  EXPECT_NEAR(value(table, "kn_level"), 3.0 * std::pow(40.0 * 60.0 * 80.0 * 100.0, 1.5 / 4.0), 1e-6);
  EXPECT_NEAR(sigma(table, "kn_level"), 0.05 / 2.0, 0.005);  // four of 5 %
  // An error of the gap is that of all tests at once: it moves the level as kn ∝ δ0^-0.82 does.
  table.numbers["gap_um"] = 2.0, table.numbers["gap_sigma_um"] = 0.2;
  EXPECT_NEAR(sigma(table, "kn_level"), std::hypot(0.025, 0.82 * 0.1), 0.01);
  EXPECT_NEAR(sigma(table, "kn_exponent"), sigma(tested(columns), "kn_exponent"), 1e-9);
}

TEST(BridgeStiffness, ErrorOfTheGapIsThatOfFiniteElements) {
  Observation table = tested({{"d_um", {74.0}}, {"D_um", {200.9}}});
  const auto at = [&](double gap) {
    table.numbers["gap_um"] = gap;
    return simulated(table, Sample{});
  };
  const Columns narrow = at(1.8), wide = at(2.2);
  const auto power = [&](const char* name) {
    return -std::log(wide.at(name)[0] / narrow.at(name)[0]) / std::log(2.2 / 1.8);
  };
  EXPECT_NEAR(power("kn_n_per_m"), 0.82, 0.08);
  EXPECT_NEAR(power("kt_n_per_m"), 0.44, 0.05);
}

}  // namespace
}  // namespace pendular::diagnosis
