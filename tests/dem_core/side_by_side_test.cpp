#include "dem_core/step/side_by_side.h"

#include <gtest/gtest.h>

#include <tuple>

#include "dem_core/step/step_kernels.h"
#include "dem_core/step/stepper.h"
#include "specimens.h"
#include "violent.h"

namespace pendular::dem_core {
namespace {

using test::disordered;
using test::sample_a;
using test::violent;

struct BankLaw {
  const char* name;
  TangentialSprings springs;
  double k_bend;
  Glass glass = Glass::linear;
  Breaking breaking = Breaking::griffith;
};

/// The runs of a bank: one specimen whose beads, diameters, friction, stiffness, bonds and speeds differ.
std::vector<Simulation> bank(const BankLaw& law, std::size_t size) {
  std::vector<Simulation> runs;
  for (std::size_t n = 0; n < size; ++n) {
    const double share = static_cast<double>(n) / 8.0;
    Sample sample = sample_a();
    sample.contact.tangential_springs = law.springs;
    sample.contact.glass = law.glass;
    sample.bridges.breaking = law.breaking;
    sample.contact.friction = 0.5 - 0.2 * share;
    sample.bridges.normal_stiffness = 5760.0 * (1.0 - 0.3 * share);
    Packing packing = disordered(3, 3);
    for (auto& bead : packing.beads) {
      const auto id = static_cast<std::uint64_t>(bead.id);
      bead.centre +=
          1e-7 * Vec3(random_normal(n, id), random_normal(n + 100, id), random_normal(n + 200, id));
      bead.diameter *= 1.0 - 0.002 * share;
    }
    for (std::size_t b = 0; b < packing.bridges.size(); ++b)
      if (b % 11 == n) packing.bridges[b].state = BridgeState::none;
    runs.push_back(violent(sample, packing, law.k_bend * (1.0 + share)));
    for (auto& velocity : runs.back().beads.velocity) velocity *= 1.0 - 0.5 * share;
    runs.back().bottom.velocity = 0.5 * (1.0 + share);
  }
  return runs;
}

/// Whether every number of two simulations is the same.
void expect_same(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.bottom.z, b.bottom.z);
  EXPECT_EQ(a.bottom.force, b.bottom.force);
  EXPECT_EQ(a.top.force, b.top.force);
  EXPECT_EQ(a.work.platen, b.work.platen);
  EXPECT_EQ(a.work.damped, b.work.damped);
  EXPECT_EQ(a.work.slipped, b.work.slipped);
  EXPECT_EQ(a.work.broken, b.work.broken);
  EXPECT_EQ(a.work.given, b.work.given);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].i, b.events[k].i);
    EXPECT_EQ(a.events[k].j, b.events[k].j);
    EXPECT_EQ(a.events[k].energy, b.events[k].energy);
  }
  for (std::size_t k = 0; k < a.beads.size(); ++k) {
    ASSERT_EQ(a.beads.position[k], b.beads.position[k]) << k;
    ASSERT_EQ(a.beads.velocity[k], b.beads.velocity[k]) << k;
    ASSERT_EQ(a.beads.spin[k], b.beads.spin[k]) << k;
  }
  EXPECT_EQ(energies(a).elastic, energies(b).elastic);
  EXPECT_EQ(energies(a).kinetic, energies(b).kinetic);
}

std::vector<Simulation*> addresses(std::vector<Simulation>& simulations) {
  std::vector<Simulation*> found;
  for (auto& simulation : simulations) found.push_back(&simulation);
  return found;
}

class SideBySideRuns : public testing::TestWithParam<std::tuple<std::string, BankLaw>> {
  void TearDown() override { use_instruction_set(instruction_sets().front()); }
};

TEST_P(SideBySideRuns, MoveAsEachDoesAlone) {
  constexpr int kSteps = 150;
  const auto& [instruction_set, law] = GetParam();
  use_instruction_set(instruction_set);
  BondEvolution softening;
  softening.change = [](const BondMoment& bond) { bond.properties.kn *= 0.99; };
  for (const std::size_t size : {8, 3}) {
    std::vector<Simulation> alone = bank(law, size), together = alone;
    std::vector<double> first_listed_at;
    for (const auto& simulation : alone) first_listed_at.push_back(simulation.listing.bottom_at);
    const auto runs = addresses(together);
    ASSERT_TRUE(SideBySide::suits(runs));
    SideBySide all(runs);
    for (int k = 0; k < kSteps; ++k) {
      all.step();
      if (k == 60)
        for (std::size_t n = 0; n < size; ++n) all.change_bonds(n, softening, 1e-6);
      if (k == 100) all.store(1), all.stop(1);
    }
    for (std::size_t n = 0; n < size; ++n) {
      if (n != 1) all.store(n);
      Stepper stepper(alone[n]);
      for (int k = 0; k < (n == 1 ? 101 : kSteps); ++k) {
        stepper.step();
        if (k == 60) stepper.change_bonds(softening, 1e-6);
      }
      stepper.store();
      EXPECT_GT(alone[n].events.size(), 10u) << "the test should break bonds";
      EXPECT_GT(alone[n].work.slipped, 0.0) << "the test should slide";
      EXPECT_NE(together[n].listing.bottom_at, first_listed_at[n]) << "pairs should be listed anew";
      expect_same(alone[n], together[n]);
      if (HasFailure()) FAIL() << "run " << n << " of " << size;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EverySet, SideBySideRuns,
                         testing::Combine(testing::ValuesIn(instruction_sets()),
                                          testing::Values(BankLaw{"TwoSprings", TangentialSprings::two, 0.0},
                                                          BankLaw{"OneSpring", TangentialSprings::one, 0.0},
                                                          BankLaw{"Bending", TangentialSprings::two, 3e-6},
                                                          BankLaw{"HertzLimits", TangentialSprings::two, 0.0,
                                                                  Glass::hertz, Breaking::limits})),
                         [](const auto& test) {
                           return std::get<0>(test.param) + std::get<1>(test.param).name;
                         });

TEST(SideBySide, SuitsRunsOfOneSpecimenOnly) {
  const BankLaw law{"", TangentialSprings::two, 0.0};
  std::vector<Simulation> runs = bank(law, 3);
  EXPECT_TRUE(SideBySide::suits(addresses(runs)));
  runs.push_back(violent(sample_a(), disordered(3, 4)));
  EXPECT_FALSE(SideBySide::suits(addresses(runs))) << "another number of beads";
  runs.back() = violent(sample_a(), disordered(3, 3), 3e-6);
  EXPECT_FALSE(SideBySide::suits(addresses(runs))) << "another law";
  Packing elsewhere = disordered(3, 3);
  std::reverse(elsewhere.beads.begin() + 1, elsewhere.beads.end());
  elsewhere.bridges = candidate_bridges(elsewhere.beads, 0.064 * 200.9e-6);
  runs.back() = violent(sample_a(), elsewhere);
  EXPECT_FALSE(SideBySide::suits(addresses(runs))) << "beads elsewhere";
}

}  // namespace
}  // namespace pendular::dem_core
