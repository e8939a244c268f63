#include "micromechanics/stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "micromechanics/stiffness_table.h"

namespace pendular::micromechanics {
namespace {

/// Bridges as a packing of sample A has them: gaps from slight overlap to the cut-off, necks and beads
/// spread.
std::vector<BridgeBody> packing_bridges(std::size_t size) {
  std::vector<BridgeBody> bodies;
  for (std::uint64_t k = 0; k < size; ++k) {
    const auto draw = [&](std::uint64_t n) { return std::clamp(random_normal(7, 4 * k + n), -3.5, 3.5); };
    bodies.push_back({73.9e-6 + 12.7e-6 * draw(0), 200.9e-6 * (0.07 * random_uniform(8, k) - 0.006),
                      200.9e-6 * (1.0 + 0.05 * draw(1)), 200.9e-6 * (1.0 + 0.05 * draw(2))});
  }
  return bodies;
}

double largest_error(const BondStiffness& a, const BondStiffness& b) {
  return std::max({std::abs(a.normal / b.normal - 1.0), std::abs(a.tangential / b.tangential - 1.0),
                   std::abs(a.bending / b.bending - 1.0), std::abs(a.twisting / b.twisting - 1.0)});
}

TEST(Stiffness, OfASampleThatStatesIt) {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  const BondStiffness bond = bond_stiffness(sample);
  EXPECT_EQ(bond.normal, 5760.0);
  EXPECT_EQ(bond.tangential, 325.0);
  const BridgeStiffness mean = bridge_stiffness(mean_bridge(sample), polymer_of(sample));
  EXPECT_EQ(bond.bending, mean.bending);
  EXPECT_EQ(bond.twisting, mean.twisting);
}

TEST(Stiffness, OfASampleThatStatesNoneIsThatOfItsMeanBridge) {
  const BondStiffness bond = bond_stiffness(Sample{});  // sample A
  EXPECT_NEAR(bond.normal, 5517.384, 0.05);
  EXPECT_NEAR(bond.tangential, 318.853, 0.005);
}

TEST(Stiffness, HalfAStatementIsBadInput) {
  Sample sample;
  sample.bridges.tangential_stiffness = 325.0;
  EXPECT_THROW(bond_stiffness(sample), BadInput);
  sample.bridges.tangential_stiffness.reset();
  sample.bridges.normal_stiffness = 5760.0;
  EXPECT_THROW(bond_stiffness(sample), BadInput);
}

TEST(Stiffness, OneForAllOrEachItsOwn) {
  const auto bodies = packing_bridges(50);
  Sample sample;
  const auto same = bond_stiffnesses(sample, bodies);
  ASSERT_EQ(same.size(), bodies.size());
  for (const auto& bond : same) EXPECT_EQ(bond.normal, bond_stiffness(sample).normal);

  sample.bridges.stiffness = StiffnessOf::per_bridge;
  const auto each = bond_stiffnesses(sample, bodies);
  ASSERT_EQ(each.size(), bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (gap_is_raised(bodies[k])) continue;
    EXPECT_LT(largest_error(each[k], bridge_stiffness(bodies[k], polymer_of(sample))), 1e-3)
        << "bridge " << k;
  }
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  EXPECT_THROW(bond_stiffnesses(sample, bodies), BadInput);
}

struct Population {
  const char* name;
  double poisson_ratio, least_neck, most_neck, most_gap, most_ratio;  ///< lengths over D, D_j/D_i
};

class StiffnessTables : public testing::TestWithParam<Population> {};

/// Finite elements refined beyond those of the table, on bridges of its range picked at random.
TEST_P(StiffnessTables, StayBelowTheirBarAndKnowTheirError) {
  const Population& p = GetParam();
  std::vector<BridgeBody> bodies;
  for (std::uint64_t k = 0; k < 400; ++k)
    bodies.push_back({p.least_neck + (p.most_neck - p.least_neck) * random_uniform(3, 3 * k),
                      1e-3 * std::pow(1e3 * p.most_gap, random_uniform(3, 3 * k + 1)), 1.0,
                      1.0 + (p.most_ratio - 1.0) * random_uniform(3, 3 * k + 2)});
  const Polymer polymer{1.0, p.poisson_ratio};
  const StiffnessTable table(bodies, polymer);
  EXPECT_LT(table.measured_error(), 5e-4);
  const BridgeResolution fine{
      .order = 6, .rim_layers = 3, .rim_ratio = 0.15, .rim_reach = 1.25, .axis_stride = 0.8};
  for (std::size_t k = 0; k < 25; ++k) {
    BridgeBody body = bodies[k];
    if (gap_is_raised(body)) continue;
    const double error = largest_error(table.at(body), bridge_stiffness_on(body, polymer, fine));
    EXPECT_LT(error, 1e-3);
    EXPECT_LT(error, 1.5 * table.measured_error() + 1e-4) << "the measured one leaves out the elements' own";
  }
}

INSTANTIATE_TEST_SUITE_P(Table, StiffnessTables,
                         testing::Values(Population{"Typical", 0.49, 0.2, 0.6, 0.064, 1.2},
                                         Population{"WholeRange", 0.499, 0.1, 0.7, 0.1, 1.25},
                                         Population{"Compressible", 0.3, 0.1, 0.75, 0.1, 1.5},
                                         Population{"EqualBeads", 0.49, 0.1, 0.8, 0.1, 1.0},
                                         Population{"EqualNecks", 0.49, 0.37, 0.37, 0.1, 1.0},
                                         Population{"EqualGaps", 0.49, 0.1, 0.8, 1e-3, 1.0}),
                         [](const auto& test) { return test.param.name; });

TEST(Stiffness, WhatIsTheSameForAllBridgesTakesOnePoint) {
  const Polymer polymer{1.5e6, 0.49};
  std::vector<BridgeBody> bodies(30, {73.9e-6, 2e-6, 200.9e-6, 200.9e-6});
  EXPECT_EQ(StiffnessTable(bodies, polymer).solutions(), 1u);
  bodies.front().gap = 12e-6;
  const StiffnessTable gaps(bodies, polymer);
  EXPECT_EQ(gaps.solutions(), 12u);
  for (const auto& body : {bodies.front(), bodies.back()})
    EXPECT_LT(largest_error(gaps.at(body), bridge_stiffness(body, polymer)), 1e-5);
  bodies.front().gap = 2.0001e-6;  // too near for points between
  EXPECT_LT(largest_error(StiffnessTable(bodies, polymer).at(bodies.front()),
                          bridge_stiffness(bodies.front(), polymer)),
            1e-5);
}

TEST(Stiffness, AskedForAgainItIsTheSameAndWhatIsNoBridgeIsRefused) {
  Sample sample;
  const BondStiffness once = bond_stiffness(sample), again = bond_stiffness(sample);
  EXPECT_EQ(once.normal, again.normal);
  EXPECT_EQ(once.bending, bridge_stiffness(mean_bridge(sample), polymer_of(sample)).bending);
  sample.bridges.youngs_modulus *= 2.0;
  EXPECT_NEAR(bond_stiffness(sample).normal / once.normal, 2.0, 1e-12);
  sample.bridges.youngs_modulus = std::nan("");
  EXPECT_THROW(bond_stiffness(sample), BadInput);
}

TEST(Stiffness, TouchingBeadsCountAsAThousandthOfTheirDiameterApart) {
  std::vector<BridgeBody> bodies = packing_bridges(20);
  BridgeBody floor = bodies[0];
  floor.gap = kSmallestGapRatio * 2.0 / (1.0 / floor.diameter_i + 1.0 / floor.diameter_j) * (1.0 + 1e-12);
  for (double gap : {-5e-6, 0.0, 1e-9}) {
    bodies[0].gap = gap;
    const BridgeStiffnesses found = bridge_stiffnesses(bodies, {1.5e6, 0.49});
    EXPECT_GE(found.raised_gaps, 1u);
    EXPECT_LT(largest_error(found.bonds[0], bridge_stiffness(floor, {1.5e6, 0.49})), 1e-3) << "gap " << gap;
  }
}

TEST(Stiffness, OfOneBridgeAndOfNone) {
  const BridgeBody body{73.9e-6, 2e-6, 200.9e-6, 200.9e-6};
  const BridgeStiffnesses one = bridge_stiffnesses(std::vector{body}, {1.5e6, 0.49});
  ASSERT_EQ(one.bonds.size(), 1u);
  EXPECT_LT(largest_error(one.bonds[0], bridge_stiffness(body, {1.5e6, 0.49})), 1e-5);
  EXPECT_EQ(one.raised_gaps, 0u);
  EXPECT_TRUE(bridge_stiffnesses({}, {1.5e6, 0.49}).bonds.empty());
}

TEST(Stiffness, OfABridgeWiderThanItsBeadIsBadInput) {
  auto bodies = packing_bridges(5);
  bodies[3].neck_diameter = 250e-6;
  EXPECT_THROW(bridge_stiffnesses(bodies, {1.5e6, 0.49}), BadInput);
}

TEST(Stiffness, DoesNotDependOnTheNumberOfThreads) {
  const auto bodies = packing_bridges(3000);
  set_threads(1);
  const auto alone = bridge_stiffnesses(bodies, {1.5e6, 0.49});
  set_threads(3);
  const auto together = bridge_stiffnesses(bodies, {1.5e6, 0.49});
  set_threads(0);
  ASSERT_EQ(alone.bonds.size(), together.bonds.size());
  EXPECT_EQ(
      std::memcmp(alone.bonds.data(), together.bonds.data(), alone.bonds.size() * sizeof(BondStiffness)), 0);
  EXPECT_EQ(alone.interpolation_error, together.interpolation_error);
}

}  // namespace
}  // namespace pendular::micromechanics
