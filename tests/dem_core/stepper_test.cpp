#include "dem_core/step/stepper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/error.h"
#include "dem_core/step/listed.h"
#include "dem_core/step/reference_step.h"
#include "dem_core/step/step_kernels.h"
#include "specimens.h"
#include "violent.h"

namespace pendular::dem_core {
namespace {

using test::disordered;
using test::sample_a;
using test::violent;

struct Law {
  const char* name;
  TangentialSprings springs;
  bool bond_friction_limit;
  double k_bend;
  double stiffness_ratio = 10.0;
  Glass glass = Glass::linear;
  Breaking breaking = Breaking::griffith;
};

/// The kernels of one instruction set against the loop that anyone can read.
class Kernel : public testing::TestWithParam<std::tuple<std::string, Law>> {
  void TearDown() override { use_instruction_set(instruction_sets().front()); }
};

TEST_P(Kernel, AgreesWithTheReferenceLoop) {
  const auto& [instruction_set, law] = GetParam();
  use_instruction_set(instruction_set);
  Sample sample = sample_a();
  sample.contact.tangential_springs = law.springs;
  sample.contact.bond_friction_limit = law.bond_friction_limit;
  sample.contact.stiffness_ratio = law.stiffness_ratio;
  sample.contact.glass = law.glass;
  sample.bridges.breaking = law.breaking;
  Simulation fast = violent(sample, disordered(4, 4), law.k_bend);
  Simulation slow = fast;
  Stepper stepper(fast);
  for (int k = 0; k < 150; ++k) {
    stepper.step();
    reference_step(slow);
    if (fast.listing.bottom_at != slow.listing.bottom_at) list_pairs(slow);
  }
  stepper.store();

  const auto listed = [](const Simulation& s) {
    std::vector<std::tuple<int, int>> broken;
    for (const auto& event : s.events) broken.emplace_back(event.i, event.j);
    std::sort(broken.begin(), broken.end());
    return broken;
  };
  EXPECT_GT(slow.events.size(), 20u) << "the test should break bonds";
  EXPECT_GT(slow.work.slipped, 0.0) << "the test should slide";
  EXPECT_EQ(listed(fast), listed(slow));
  const auto worst = [&](auto BeadStates::*field) {
    double difference = 0.0, scale = 0.0;
    for (std::size_t k = 0; k < slow.beads.size(); ++k) {
      difference = std::max(difference, ((fast.beads.*field)[k] - (slow.beads.*field)[k]).norm());
      scale = std::max(scale, (slow.beads.*field)[k].norm());
    }
    return difference / scale;
  };
  EXPECT_LT(worst(&BeadStates::position), 1e-12);
  EXPECT_LT(worst(&BeadStates::velocity), 1e-9);
  EXPECT_LT(worst(&BeadStates::spin), 1e-9);
  EXPECT_NEAR(fast.work.slipped, slow.work.slipped, 1e-8 * slow.work.slipped);
  // The kernels keep the last closing speed in single precision: it enters this sum alone.
  EXPECT_NEAR(fast.work.damped, slow.work.damped, 1e-6 * slow.work.damped);
  EXPECT_NEAR(energies(fast).elastic, energies(slow).elastic, 1e-8 * energies(slow).elastic);
}

INSTANTIATE_TEST_SUITE_P(
    EverySet, Kernel,
    testing::Combine(testing::ValuesIn(instruction_sets()),
                     testing::Values(Law{"TwoSprings", TangentialSprings::two, false, 0.0},
                                     Law{"TwoSpringsCoulomb", TangentialSprings::two, true, 0.0},
                                     Law{"OneSpring", TangentialSprings::one, false, 0.0},
                                     Law{"OneSpringCoulomb", TangentialSprings::one, true, 0.0},
                                     Law{"Bending", TangentialSprings::two, false, 3e-6},
                                     Law{"SoftGlass", TangentialSprings::two, false, 0.0, 0.01},
                                     Law{"Hertz", TangentialSprings::two, false, 0.0, 10.0, Glass::hertz},
                                     Law{"HertzOneSpringLimits", TangentialSprings::one, true, 0.0, 10.0,
                                         Glass::hertz, Breaking::limits})),
    [](const auto& test) { return std::get<0>(test.param) + std::get<1>(test.param).name; });

TEST(Stepper, RenumberedBeadsMoveTheSame) {
  const Packing packing = disordered(4, 4);
  Packing renumbered = packing;
  std::reverse(renumbered.beads.begin(), renumbered.beads.end());
  const int last = static_cast<int>(packing.beads.size()) - 1;
  for (auto& bridge : renumbered.bridges) {
    bridge.i = last - bridge.i, bridge.j = last - bridge.j;
    if (bridge.i > bridge.j) std::swap(bridge.i, bridge.j);
  }
  Simulation one = violent(sample_a(), packing), other = violent(sample_a(), renumbered);
  Stepper first(one), second(other);
  for (int k = 0; k < 150; ++k) first.step(), second.step();
  first.store(), second.store();
  EXPECT_EQ(one.events.size(), other.events.size());
  for (int k = 0; k <= last; ++k)
    ASSERT_LT((one.beads.position[k] - other.beads.position[last - k]).norm(), 1e-14) << k;
}

TEST(Stepper, ATurnedSpecimenMovesTheSame) {
  // Without platens no direction in space is special.
  const Packing packing = disordered(4, 4);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  Simulation upright = violent(sample_a(), packing);
  upright.bottom.z -= 1.0, upright.top.z += 1.0, upright.bottom.velocity = 0.0;
  list_pairs(upright);
  Simulation turned = upright;
  auto& beads = turned.beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (Vec3* v : {&beads.position[k], &beads.velocity[k], &beads.spin[k]}) *v = turn * *v;
    turned.listing.at[k] = beads.position[k];
  }
  Stepper first(upright), second(turned);
  for (int k = 0; k < 150; ++k) first.step(), second.step();
  first.store(), second.store();
  EXPECT_GT(upright.events.size(), 20u);
  EXPECT_EQ(upright.events.size(), turned.events.size());
  for (std::size_t k = 0; k < beads.size(); ++k)
    ASSERT_LT((turn * upright.beads.position[k] - beads.position[k]).norm(), 1e-13) << k;
}

TEST(Stepper, PairsAreListedAnewWhereOneBeadHasMovedByItsMargin) {
  const auto listed_anew = [](const Vec3& moved_by_first, const Vec3& moved_by_second) {
    Simulation simulation = build_simulation(disordered(4, 4), sample_a());
    Listing& listing = simulation.listing;
    listing.at[0] -= listing.margin[0] * moved_by_first;
    listing.at[1] -= listing.margin[1] * moved_by_second;
    const std::vector<Vec3> before = listing.at;
    Stepper stepper(simulation);
    stepper.step();
    return simulation.listing.at != before;
  };
  EXPECT_FALSE(listed_anew({0.9, 0, 0}, {0, 0.9, 0})) << "no bead has moved by its margin";
  EXPECT_FALSE(listed_anew({0.57, 0.57, 0.57}, {0, 0, 0}));
  EXPECT_TRUE(listed_anew({0.58, 0.58, 0.58}, {0, 0, 0}));
  EXPECT_TRUE(listed_anew({0, 0, 0}, {0.8, 0.8, 0}));
}

TEST(Stepper, APairIsListedUntilItsDampingIsBooked) {
  const auto listed = [](double closing) {
    Simulation simulation = build_simulation(disordered(4, 4), sample_a());
    Pair& pair = simulation.pairs.front();
    const int i = pair.i, j = pair.j;
    pair.bond = -1, pair.history.closing = closing;
    simulation.beads.position[i] += Vec3(-1, 0, 0);
    list_pairs(simulation);
    return find_pair(simulation, i, j) != nullptr;
  };
  EXPECT_TRUE(listed(1e-6));
  EXPECT_FALSE(listed(0.0));
}

TEST(Stepper, WhenPairsAreListedDoesNotShow) {
  Simulation often = violent(sample_a(), disordered(4, 4)), seldom = often;
  Stepper first(often);
  Stepper second(seldom);
  for (int k = 0; k < 150; ++k) {
    first.step(), second.step();
    if (k % 7 != 0) continue;
    first.store();
    list_pairs(often);
    first.load();
    if (k % 3 != 0) continue;
    second.store();
    list_pairs(seldom, 5e-6);
    second.load();
  }
  first.store(), second.store();
  EXPECT_GT(often.events.size(), 20u);
  EXPECT_EQ(often.work.damped, seldom.work.damped);
  EXPECT_EQ(often.work.slipped, seldom.work.slipped);
  for (std::size_t k = 0; k < often.beads.size(); ++k) {
    ASSERT_EQ(often.beads.position[k], seldom.beads.position[k]) << k;
    ASSERT_EQ(often.beads.spin[k], seldom.beads.spin[k]) << k;
  }
}

TEST(Stepper, UnknownInstructionSetIsRefused) {
  EXPECT_THROW(use_instruction_set("MMX"), BadInput);
}

}  // namespace
}  // namespace pendular::dem_core
