#include "diagnosis/inference/leading.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/inference/problem.h"
#include "diagnosis/thresholds.h"
#include "signatures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace pendular::diagnosis {
namespace {

/// Four features, which two effects move in directions of their own; a gap of both.
Problem pair_of(double missing, double friction) {
  Comparison one;
  one.gap.covariance = Eigen::Matrix4d::Identity();
  one.gap.believed = Eigen::MatrixXd::Zero(4, 0);
  one.signatures = {
      test::signature("missing_bridges", 100.0 * Eigen::Vector4d(1, 0.5, 0, 0), 0.0, 0.3, 0.15, 0.036),
      test::signature("bead_friction", 80.0 * Eigen::Vector4d(0, 0, 1, -0.5), -0.4, 0.4, 0.2, 0.048)};
  one.gap.values = one.signatures[0].at(missing) + one.signatures[1].at(friction);
  return {one, one, {}};
}

std::vector<DesignPoint> led_by(const Problem& problem, const BankPlan& plan) {
  return leading_points(known_explanations(problem.readings, {}), plan);
}

std::vector<DesignPoint> fitted_to(const Problem& problem, const BankPlan& plan) {
  return fitted_points(problem.readings, known_explanations(problem.readings, {}), plan);
}

BankPlan plan(int further) {
  BankPlan made;
  made.conditions.resize(1);
  made.size = {1.0};
  made.further = further;
  for (int member = 1; member <= 6; ++member) made.points.push_back({member, ""});
  for (const double sds : {-2.0, -1.0, 1.0, 2.0}) made.points.push_back({1, "contact.friction", sds});
  return made;
}

TEST(Leading, PairsThatMightExplainTheGapAreRunNearTheirMagnitudes) {
  const auto points = led_by(pair_of(0.2, -0.26), plan(96));
  std::map<std::string, std::set<int>> members;
  for (const auto& point : points) {
    members[point.id].insert(point.member);
    if (point.changes.size() != 2) continue;
    EXPECT_NEAR(point.changes.at("missing_bridges"), 0.2, 1e-9);  // thirds of 0.3 and of −0.4
    EXPECT_NEAR(point.changes.at("bead_friction"), -0.8 / 3.0, 1e-9);
  }
  EXPECT_EQ(members["bead_friction+missing_bridges"], (std::set<int>{1, 2, 3, 4}));
}

TEST(Leading, WhatWasRunIsNotRunAgain) {
  BankPlan known = plan(96);
  const Problem problem = pair_of(0.2, -0.26);
  known.points = led_by(problem, known);
  ASSERT_FALSE(known.points.empty());
  EXPECT_TRUE(led_by(problem, known).empty());
}

TEST(Leading, TheBudgetIsKept) {
  EXPECT_TRUE(led_by(pair_of(0.2, -0.26), plan(3)).empty());
  EXPECT_EQ(led_by(pair_of(0.2, -0.26), plan(4)).size(), 4u);
}

/// With what friction does, believed with 0.05, in a direction that no effect has, and a little of the other
/// effect.
Problem misbelieved(double missing, double by_sds, double other = -0.025) {
  Problem problem = pair_of(missing, other);
  Comparison& readings = problem.readings;
  readings.inputs = {"contact.friction", std::string("contact.friction") + kCurvature, kSimulationError};
  readings.gap.believed = Eigen::MatrixXd::Zero(4, 3);
  readings.gap.believed.col(0) = 20.0 * Eigen::Vector4d(-0.5, 1, 0, 0);
  readings.gap.values += by_sds * readings.gap.believed.col(0);
  return problem;
}

TEST(Leading, WhatLeadsIsRunAsItFitsWithWhatIsBelieved) {
  const Problem problem = misbelieved(0.2, -1.52);
  BankPlan known = plan(96);
  std::set<int> members;
  for (const auto& point : fitted_to(problem, known)) {
    if (point.id != "missing_bridges") continue;
    EXPECT_TRUE(point.at_fit);
    ASSERT_EQ(point.changes.size(), 2u);
    EXPECT_NEAR(point.changes.at("missing_bridges"), 0.2, 0.01);
    EXPECT_DOUBLE_EQ(point.changes.at("contact.friction"), -1.5);
    members.insert(point.member);
  }
  EXPECT_EQ(members, (std::set<int>{1, 2, 3, 4, 5, 6}));  // all that there are, of what draws
  const auto run = fitted_to(problem, known);
  known.points.insert(known.points.end(), run.begin(), run.end());
  EXPECT_TRUE(fitted_to(problem, known).empty());
  EXPECT_TRUE(fitted_to(problem, plan(3)).empty());
}

TEST(Leading, RunsGoNoFartherThanTheBankDoes) {
  BankPlan known = plan(96);
  std::erase_if(known.points, [](const DesignPoint& point) { return point.theta == 2.0; });
  for (const double sds : {3.0, -3.0})
    for (const auto& point : fitted_to(misbelieved(0.2, sds), known))
      if (point.id == "missing_bridges") {
        EXPECT_DOUBLE_EQ(point.changes.at("contact.friction"), sds > 0.0 ? 1.0 : -2.0);
      }
}

TEST(Leading, AtItsFitWhatLeadsFollowsTheNearerReadingOfALaw) {
  const LawReading& glass = *find_law_reading("glass");
  for (const double share : {0.2, 0.9}) {
    Problem problem = misbelieved(0.2, share / kThresholds.law_reading);
    problem.readings.inputs[0] = glass.name;
    const auto points = fitted_to(problem, plan(96));
    ASSERT_FALSE(points.empty());
    for (const auto& point : points)
      if (point.id == "missing_bridges") {
        EXPECT_EQ(point.changes.contains("glass"), share > 0.5) << share;
      }
  }
}

TEST(Leading, WhatIsAloneAndLeavesNoMoreThanTheNoiseNeedsNoRunsAtItsFit) {
  EXPECT_FALSE(fitted_to(misbelieved(0.2, 1.0), plan(96)).empty());
  EXPECT_TRUE(fitted_to(misbelieved(0.2, 1.0, 0.0), plan(96)).empty());
}

// A pair is more than its effects only where those, as they fit best, leave something.
TEST(Leading, ThePartsOfALeadingPairAreRunAsTheyFitToo) {
  Problem problem = pair_of(0.2, -0.06);
  problem.readings.together = {{"missing_bridges", "bead_friction", 0.2, -0.06, Eigen::VectorXd::Zero(4),
                                Eigen::MatrixXd::Zero(4, 4)}};
  std::set<std::string> run;
  for (const auto& point : fitted_to(problem, plan(96))) run.insert(point.id);
  EXPECT_EQ(run,
            (std::set<std::string>{"bead_friction", "missing_bridges", "missing_bridges+bead_friction"}));
}

// One effect and wrong beliefs leave what two effects explain by chance: a pair that was not run counts.
TEST(Leading, WhatAPairMayExplainInsteadIsRunAtItsFit) {
  std::set<std::string> run;
  for (const auto& point : fitted_to(pair_of(0.2, -0.06), plan(96))) run.insert(point.id);
  EXPECT_EQ(run, (std::set<std::string>{"missing_bridges"}));
}

TEST(Leading, NothingLeadsWhereThereIsNoGap) {
  for (const auto& point : led_by(pair_of(0.0, 0.0), plan(96))) EXPECT_EQ(point.changes.size(), 1u);
}

}  // namespace
}  // namespace pendular::diagnosis
