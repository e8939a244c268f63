#include "diagnosis/inference/stated_laws.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr Eigen::Index kFeatures = 20;

/// Readings with noise of one each, of which a law's other reading moves the first by `does`, by ± `differs`
/// from member to member, and by `followed` times that in the experiment; `left` of the noise in all others.
Comparison readings_with(double does, double differs, double followed, double left = 1.0) {
  Comparison found;
  found.gap.values = Eigen::VectorXd::Zero(kFeatures);
  for (Eigen::Index f = 0; f < kFeatures; ++f)
    found.gap.values[f] = left * random_normal(5, static_cast<std::uint64_t>(f));
  LawResponse law{"glass", Eigen::VectorXd::Zero(kFeatures), Eigen::MatrixXd::Zero(kFeatures, kFeatures)};
  law.mean[0] = does, law.scatter(0, 0) = differs * differs;
  found.gap.values[0] = followed * does;
  const double open = kThresholds.law_reading;
  found.gap.covariance = Eigen::MatrixXd::Identity(kFeatures, kFeatures);
  found.gap.covariance(0, 0) += (1.0 + kThresholds.uncorrelated) * open * open * law.scatter(0, 0);
  found.gap.believed = open * law.mean;
  found.inputs = {find_law_reading("glass")->name};
  found.laws = {law};
  return found;
}

bool settled(const Comparison& readings) {
  Hypothesis none;
  none.id = "none", none.probability = 1.0;
  return laws_as_stated(readings, {none}).contains("glass");
}

TEST(StatedLaws, WhatTheExperimentShowsIsSettled) {
  EXPECT_TRUE(settled(readings_with(5.0, 0.0, 0.0)));
  EXPECT_TRUE(settled(readings_with(5.0, 0.0, 0.1)));
  EXPECT_FALSE(settled(readings_with(5.0, 0.0, 1.0)));   // the other reading
  EXPECT_FALSE(settled(readings_with(5.0, 0.0, 0.45)));  // neither
  EXPECT_FALSE(settled(readings_with(1.0, 0.0, 0.0)));   // it could not be seen
}

// ln 100 = ½ (does / σ)² with σ² of the noise and the remainder of one tenth: 3.1.
TEST(StatedLaws, FromThreeStandardDeviationsOn) {
  EXPECT_FALSE(settled(readings_with(2.9, 0.0, 0.0)));
  EXPECT_TRUE(settled(readings_with(3.3, 0.0, 0.0)));
}

// Where members differ by as much as the law does on average, nothing is shown by one that it does little to.
TEST(StatedLaws, WhatDiffersFromMemberToMemberIsHarderToTell) {
  EXPECT_FALSE(settled(readings_with(5.0, 5.0, 0.0)));
  EXPECT_TRUE(settled(readings_with(50.0, 5.0, 0.0)));
}

TEST(StatedLaws, WhereMuchIsLeftOneReadingTellsLess) {
  EXPECT_TRUE(settled(readings_with(4.0, 0.0, 0.0)));
  EXPECT_FALSE(settled(readings_with(4.0, 0.0, 0.0, 3.0)));
}

// Each explanation that is probable must say so; others do not count.
TEST(StatedLaws, EveryProbableExplanationHasToAgree) {
  Comparison readings = readings_with(5.0, 0.0, 0.0);
  Signature effect;
  effect.id = "platen_tilt";
  effect.powers = {Eigen::VectorXd::Zero(kFeatures)};
  effect.powers[0][0] = -5.0;
  readings.signatures = {effect};
  Hypothesis none, tilt;
  none.id = "none", none.probability = 0.9;
  tilt.id = "platen_tilt", tilt.probability = 0.1, tilt.magnitudes = {{1.0, {0.9, 1.1}}};
  EXPECT_FALSE(laws_as_stated(readings, {none, tilt}).contains("glass"));
  tilt.probability = 0.001;
  EXPECT_TRUE(laws_as_stated(readings, {none, tilt}).contains("glass"));
}

}  // namespace
}  // namespace pendular::diagnosis
