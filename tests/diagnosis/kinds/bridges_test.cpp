#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"
#include "diagnosis/thresholds.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

constexpr int kPairs = 400;

/// Pairs of beads 1–2, 3–4, …: every other one steep, bridged as `joined` says; necks where they are.
Observation network(const std::function<double(int)>& joined, double spread = 0.0, double error = 0.0) {
  Columns columns;
  for (int k = 0; k < kPairs; ++k) {
    const auto n = static_cast<std::uint64_t>(k);
    columns["bead_i"].push_back(2 * k + 1), columns["bead_j"].push_back(2 * k + 2);
    columns["joined"].push_back(joined(k));
    columns["cosine"].push_back(k % 2 ? 0.1 : 0.9);
    columns["height"].push_back((k + 0.5) / kPairs);
    columns["radius"].push_back(0.5);
    columns["separation_um"].push_back(k % 10);
    const bool neck = joined(k) == 1.0 && error + spread > 0.0;
    columns["bridge_diameter_um"].push_back(
        neck ? 74.0 + spread * random_normal(1, n) + error * random_normal(2, n) : 0.0);
    columns["sigma_bridge_diameter_um"].push_back(neck ? error : 0.0);
  }
  return observation(kinds::bridges(), "network", columns);
}

TEST(Bridges, AreComparedByTheShareOfPairsThatTheyJoin) {
  // None of the flat pairs is joined, and no steep one in the upper half.
  const Observation half = network([](int k) { return double(k % 2 == 0 && k < kPairs / 2); });
  EXPECT_NEAR(value(half, "bridged_share"), 0.25, 1e-12);
  EXPECT_NEAR(value(half, "bridged_steep"), 0.5, 1e-12);
  EXPECT_NEAR(value(half, "bridged_flat"), 0.0, 1e-12);
  EXPECT_NEAR(value(half, "bridged_low"), 0.5, 0.01);
  EXPECT_NEAR(value(half, "bridged_high"), 0.0, 1e-12);
}

TEST(Bridges, UndeterminedPairsDoNotCount) {
  const Observation some = network([](int k) { return k % 4 == 0 ? std::nan("") : double(k % 4 == 1); });
  EXPECT_NEAR(value(some, "bridged_share"), 1.0 / 3.0, 1e-12);
}

TEST(Bridges, ErrorsOfNecksAreTakenOffTheirSpread) {
  const Observation necks = network([](int) { return 1.0; }, 7.0, 5.0);
  EXPECT_NEAR(value(necks, "neck_mean"), 74.0, 1.0);
  EXPECT_NEAR(value(necks, "neck_spread"), 7.0 / 74.0, 0.012);
}

// Of a sample of normal necks: the spread over the root of twice their number; where errors are taken off,
// what these may be off by as well.
TEST(Bridges, SpreadOfNecksIsKnownAsWellAsTheirErrors) {
  const Observation exact = network([](int) { return 1.0; }, 7.0, 0.01);
  EXPECT_NEAR(sigma(exact, "neck_spread"), 7.0 / 74.0 / std::sqrt(2.0 * kPairs), 0.0008);
  EXPECT_NEAR(sigma(exact, "neck_mean"), 7.0 / 74.0 / std::sqrt(kPairs), 0.0012);
  const Observation noisy = network([](int) { return 1.0; }, 7.0, 3.5);
  const double variance = 7.0 * 7.0 + 3.5 * 3.5, of_number = variance / std::sqrt(2.0 * kPairs) / 7.0,
               of_errors = kThresholds.stated_error * 3.5 * 3.5 / 7.0;
  EXPECT_NEAR(sigma(noisy, "neck_spread"), std::hypot(of_number, of_errors) / 74.0, 0.002);
}

// A table whose errors are stated a quarter too small shows a spread that is not there: no more than its
// standard deviations say.
TEST(Bridges, MisstatedErrorsAreNoSpread) {
  Observation necks = network([](int) { return 1.0; }, 0.0, 1.5);
  for (double& one : necks.columns["sigma_bridge_diameter_um"]) one *= 0.75;
  EXPECT_GT(value(necks, "neck_spread"), 0.008);
  EXPECT_LT(value(necks, "neck_spread"), 4.0 * sigma(necks, "neck_spread"));
}

TEST(Bridges, StatesChangeAsOftenAsTheirProbabilitySays) {
  Observation sure = network([](int k) { return double(k % 2); });
  for (const double joined : sure.column("joined"))
    sure.columns["probability"].push_back(joined == 1.0 ? 0.9 : 0.05);
  double lost = 0.0, won = 0.0;
  for (unsigned long seed = 0; seed < 20; ++seed) {
    const auto again = sure.kind->perturbed(sure, 100 * seed).at("joined");
    for (std::size_t k = 0; k < again.size(); ++k)
      (sure.column("joined")[k] == 1.0 ? lost : won) += again[k] != sure.column("joined")[k];
  }
  // Of 4,000 each, within four standard errors.
  EXPECT_NEAR(lost, 400.0, 4.0 * std::sqrt(4000.0 * 0.1 * 0.9));
  EXPECT_NEAR(won, 200.0, 4.0 * std::sqrt(4000.0 * 0.05 * 0.95));
  // Of all pairs: the binomial's standard deviation.
  EXPECT_NEAR(sigma(sure, "bridged_share"), std::sqrt((0.09 + 0.0475) / 2.0 / kPairs), 0.0015);
}

/// A frame in which the pairs of some numbers stand, and others are broken.
SimulatedTest scan(double strain, const std::function<bool(int)>& stands,
                   const std::function<bool(int)>& broken) {
  SimulatedTest test;
  test.frames.resize(1);
  test.frames[0].strain = strain;
  for (int k = 0; k < kPairs; ++k) {
    const PairOfIds pair = {2 * k + 1, 2 * k + 2};
    if (stands(k)) test.frames[0].standing.push_back(pair);
    if (broken(k)) test.frames[0].broken.push_back(pair);
  }
  return test;
}

TEST(Bridges, AreSimulatedByTheFrameOfTheScan) {
  Observation loaded = network([](int) { return 1.0; });
  std::swap(loaded.columns["bead_i"][0], loaded.columns["bead_j"][0]);  // pairs have no order
  const auto test = scan(
      0.02, [](int k) { return k < 100; }, [](int k) { return k >= 100 && k < 140; });
  const auto share = [&] {
    return value(features_of(Level::readings, loaded, loaded.kind->simulate(loaded, {Sample{}, &test})),
                 "bridged_share");
  };
  loaded.numbers["strain"] = 0.02;
  EXPECT_NEAR(share(), 100.0 / kPairs, 1e-12);
  loaded.numbers["strain"] = 0.0;  // at rest nothing was broken yet
  EXPECT_NEAR(share(), 140.0 / kPairs, 1e-12);
}

TEST(Bridges, SimulatedNecksAreTheSamples) {
  const Observation necks = network([](int) { return 1.0; }, 7.0, 5.0);
  const auto test = scan(
      1e-3, [](int) { return true; }, [](int) { return false; });
  Sample sample;
  sample.bridges.diameter = 60e-6, sample.bridges.diameter_sd = 6e-6;
  const auto features = features_of(Level::readings, necks, necks.kind->simulate(necks, {sample, &test}));
  EXPECT_NEAR(value(features, "neck_mean"), 60.0, 1e-9);
  EXPECT_NEAR(value(features, "neck_spread"), 0.1, 1e-9);
}

TEST(Bridges, TheirTestKeepsAFrameAtTheStrainOfTheScan) {
  Observation one = network([](int) { return 1.0; });
  Sample::Compression course;
  one.kind->course(one, course);
  one.numbers["strain"] = 0.02;
  one.kind->course(one, course);
  EXPECT_EQ(course.frame_at, (std::vector{kRestStrain, 0.02}));
}

TEST(Bridges, ErrorsOfTheSimulationAreAPositiveDefiniteCovariance) {
  const Observation necks = network([](int) { return 1.0; }, 7.0, 5.0);
  const auto features = features_of(Level::readings, necks, necks.columns);
  test::expect_covariance(necks.kind->model_error(features), features.size());
}

}  // namespace
}  // namespace pendular::diagnosis
