#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

TEST(BrokenBonds, ScatterAsCountsDo) {
  const Observation breaks =
      observation(kinds::broken_bonds(), "AE", {{"strain", {0.01, 0.02, 0.03, 0.04}}, {"count", {0, 100, 250, 400}}});
  EXPECT_EQ(value(breaks, "breaks_at_half"), 101.0);
  EXPECT_NEAR(sigma(breaks, "breaks_at_half"), 0.1, 0.02);
  EXPECT_NEAR(sigma(breaks, "breaks_at_end"), 0.05, 0.01);
  // The root of a Poisson count scatters by a half, whatever the count.
  EXPECT_NEAR(value(breaks, "root_breaks_at_3.0_percent", Level::readings), std::sqrt(250.25), 1e-9);
  for (const char* name : {"root_breaks_at_2.0_percent", "root_breaks_at_4.0_percent"})
    EXPECT_NEAR(sigma(breaks, name, Level::readings), 0.5, 0.08);
}

TEST(BrokenBonds, AreReadByStraightLinesFromNoneAtRest) {
  const Observation breaks =
      observation(kinds::broken_bonds(), "AE", {{"strain", {0.02, 0.03}}, {"count", {80, 240}}});
  const auto count = [&](const char* at) {
    return std::pow(value(breaks, fmt::format("root_breaks_at_{}_percent", at), Level::readings), 2) - 0.25;
  };
  EXPECT_NEAR(count("1.0"), 40.0, 1e-9);
  EXPECT_NEAR(count("2.0"), 80.0, 1e-9);
  // On the way of an unloading nothing breaks for the first time.
  Columns loop = {{"strain", {0.01, 0.02, 0.015, 0.02, 0.03}}, {"count", {10, 80, 80, 80, 240}}};
  EXPECT_NEAR(value(features_of(Level::readings, breaks, loop), "root_breaks_at_2.0_percent"), std::sqrt(80.25), 1e-9);
}

TEST(BrokenBonds, OfEachRowAreAddedUp) {
  Observation breaks =
      observation(kinds::broken_bonds(), "AE", {{"strain", {0.01, 0.02, 0.03}}, {"count", {5, 20, 3}}});
  breaks.words["counts"] = "per_interval";
  std::vector<std::string> warnings;
  breaks.kind->check(Sample{}, breaks, warnings);
  EXPECT_EQ(breaks.column("count"), (std::vector{5.0, 25.0, 28.0}));
  // They have become totals: looked at again they stay.
  breaks.kind->check(Sample{}, breaks, warnings);
  EXPECT_EQ(breaks.column("count"), (std::vector{5.0, 25.0, 28.0}));
  EXPECT_TRUE(warnings.empty());
}

TEST(BrokenBonds, AreSimulatedByTheRowsOfTheirTest) {
  SimulatedTest test;
  test.rows.resize(2);
  test.rows[1].strain = 0.01, test.rows[1].broken_bonds = 7;
  EXPECT_EQ(kinds::broken_bonds().simulate({}, {Sample{}, &test}).at("count"), (std::vector{0.0, 7.0}));
}

TEST(BrokenBonds, ErrorsOfTheSimulationAreAPositiveDefiniteCovariance) {
  const Observation breaks =
      observation(kinds::broken_bonds(), "AE", {{"strain", {0.02, 0.05}}, {"count", {80, 240}}});
  for (const Level level : {Level::landmarks, Level::readings}) {
    const auto features = features_of(level, breaks, breaks.columns);
    test::expect_covariance(breaks.kind->model_error(features), features.size());
  }
}

}  // namespace
}  // namespace pendular::diagnosis
