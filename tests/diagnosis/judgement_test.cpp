#include "diagnosis/inference/judgement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/repair/shrinkage.h"
#include "diagnosis/thresholds.h"
#include "diagnosis/verdict.h"
#include "signatures.h"

namespace pendular::diagnosis {
namespace {

/// Three features of one curve, read alike at both levels; compliance and missing bridges lower the first
/// alike and differ in the second.
Problem planted(const Eigen::Vector3d& gap) {
  Comparison one;
  for (const char* name : {"linear_modulus", "coordination", "peak_stress"})
    one.observed.features.push_back({"A", name, Scale::aggregate, true, 1.0, 0.0, 0.0});
  one.observed.observation = {0, 0, 0};
  one.observed.measurement = 4e-4 * Eigen::Matrix3d::Identity();
  one.observed.model = Eigen::Matrix3d::Zero();
  one.simulated = Eigen::Vector3d::Zero();
  one.gap.values = gap;
  one.gap.covariance = one.observed.measurement;
  one.gap.believed = Eigen::Vector3d(0.03, 0.0, 0.02);
  one.inputs = {"bridges.youngs_modulus_pa"};
  one.signatures = {test::signature("missing_bridges", Eigen::Vector3d(-2.0, -1.0, -1.5), 0.0, 0.4, 0.15),
                    test::signature("machine_compliance", Eigen::Vector3d(-0.05, 0.0, 0.0), 0.0, 13.0, 5.0)};
  one.noise.resize(3);
  return {one, one, {}};
}

Experiment one_curve() {
  Experiment experiment;
  Observation curve;
  curve.name = std::string("A");  // assigned as characters, the compiler warns of an overlap that is none
  curve.columns = {{"strain", {0.0, 0.1}}, {"stress_pa", {0.0, 1.0}}};
  experiment.observations = {curve};
  experiment.uncertainty = {{"bridges.youngs_modulus_pa", 5e4}};
  return experiment;
}

Diagnosis judged(const Eigen::Vector3d& gap) {
  Diagnosis diagnosis;
  judge(planted(gap), {}, {}, one_curve(), diagnosis);
  return diagnosis;
}

double total(const Diagnosis& diagnosis) {
  double sum = 0.0;
  for (const auto& e : diagnosis.explanations) sum += e.probability;
  return sum;
}

// Whatever explains the gap, what an observation shows by itself that no effect brings about is unknown; by
// chance one in five shows as much.
TEST(Judgement, WhatNoEffectBringsAboutIsUnknown) {
  for (const double by_chance : {1e-12, 0.2}) {
    Kind kind = kinds::compression();
    kind.unlike = [&](const Observation&) { return Unlike{by_chance, "bridges are uneven"}; };
    Experiment experiment = one_curve();
    experiment.observations.front().kind = &kind;
    Diagnosis diagnosis;
    judge(planted({-0.4, -0.2, -0.3}), {}, {}, experiment, diagnosis);
    const Explanation& best = diagnosis.explanations.front();
    if (by_chance == 0.2) {
      EXPECT_EQ(best.id, "missing_bridges");
      EXPECT_EQ(diagnosis.unlike, "");
      continue;
    }
    EXPECT_EQ(best.id, kUnknown);
    EXPECT_GT(best.probability, 0.9);
    EXPECT_EQ(best.reason, "bridges are uneven");
    EXPECT_NE(verdict_of(diagnosis).find("bridges are uneven, which no effect"), std::string::npos);
  }
}

TEST(Judgement, NamesAPlantedEffectAndItsMagnitude) {
  const auto diagnosis = judged({-0.4, -0.2, -0.3});
  EXPECT_EQ(diagnosis.explanations.front().id, "missing_bridges");
  EXPECT_EQ(diagnosis.nearest_signature, "missing_bridges");
  // No other effect does that. Something unknown may do the same to a curve.
  EXPECT_EQ(diagnosis.ambiguity_set, (std::vector<std::string>{"missing_bridges", "unknown"}));
  double not_run = 0.0;  // pairs with it, which no run has
  for (const auto& e : diagnosis.explanations) {
    if (e.id == "unknown") {
      EXPECT_GT(e.probability, 0.02);
    }
    if (e.id == kOtherPairs) not_run = e.probability;
  }
  EXPECT_GT(diagnosis.explanations.front().probability, 3.0 * not_run);
  EXPECT_GT(diagnosis.set_probability + not_run, 0.9);
  EXPECT_NEAR(diagnosis.explanations.front().magnitudes.front().mean, 0.2, 0.02);
  EXPECT_NEAR(total(diagnosis), 1.0, 1e-9);
  for (const auto& e : diagnosis.explanations)
    EXPECT_EQ(e.id == "machine_compliance", e.excluded && !e.reason.empty());
  ASSERT_EQ(diagnosis.groups.size(), 1u);
  EXPECT_NEAR(diagnosis.groups.front().magnitude.mean, 0.2, 0.03);
  EXPECT_NE(verdict_of(diagnosis).find("missing_bridges"), std::string::npos);
}

TEST(Judgement, NoGapNeedsNoExplanation) {
  const auto diagnosis = judged({0.01, -0.01, 0.01});
  EXPECT_EQ(diagnosis.explanations.front().id, "none");
  EXPECT_EQ(diagnosis.nearest_signature, "none");
  EXPECT_NE(verdict_of(diagnosis).find("effect is needed"), std::string::npos);
}

TEST(Judgement, SaysWhichReadingOfTheLawTheExperimentFollows) {
  const Eigen::Vector3d of_hertz(0.0, 0.1, 0.4);  // what no effect does
  const auto law_at = [&](double share, Glass stated) {
    Problem problem = planted(share * of_hertz);
    for (Comparison* one : {&problem.landmarks, &problem.readings}) {
      one->gap.believed.conservativeResize(3, 2);
      one->gap.believed.col(1) = kThresholds.law_reading * of_hertz;
      one->inputs.push_back(find_law_reading("glass")->name);
    }
    Experiment experiment = one_curve();
    experiment.sample.contact.glass = stated;
    Diagnosis diagnosis;
    judge(problem, {}, {}, experiment, diagnosis);
    return std::pair(diagnosis.law, verdict_of(diagnosis));
  };
  const auto [followed, verdict] = law_at(1.0, Glass::linear);
  ASSERT_EQ(followed.size(), 1u) << verdict;
  EXPECT_EQ(followed.front().setting, "contact.glass = \"hertz\"");
  EXPECT_NEAR(followed.front().share, 1.0, 0.1);
  EXPECT_LT(followed.front().error, 0.1);
  EXPECT_NE(verdict.find("contact.glass = \"hertz\""), std::string::npos) << verdict;
  EXPECT_EQ(law_at(1.0, Glass::hertz).first.front().setting, "contact.glass = \"linear\"");
  EXPECT_TRUE(law_at(0.0, Glass::linear).first.empty());
  EXPECT_TRUE(law_at(-1.0, Glass::linear).first.empty()) << "the other way is no reading";
}

// A tenth of the other reading is left as noise, in which a pull is no share that counts.
TEST(Judgement, SaysWhichReadingsAreTheSamples) {
  const Eigen::Vector3d of_hertz(0.0, 0.5, 2.0);
  Problem problem = planted(0.09 * of_hertz);
  for (Comparison* one : {&problem.landmarks, &problem.readings}) {
    one->gap.believed.conservativeResize(3, 2);
    one->gap.believed.col(1) = kThresholds.law_as_stated * of_hertz;
    one->inputs.push_back(find_law_reading("glass")->name);
  }
  BankPlan plan;
  plan.as_stated = {"glass"};
  Diagnosis diagnosis;
  judge(problem, {}, plan, one_curve(), diagnosis);
  EXPECT_EQ(diagnosis.law_as_stated, (std::vector<std::string>{"glass"}));
  EXPECT_TRUE(diagnosis.law.empty());
}

TEST(Judgement, WhatNoEffectCanDoIsUnknown) {
  const auto diagnosis = judged({0.4, -0.4, 0.5});
  EXPECT_EQ(diagnosis.explanations.front().id, "unknown");
  EXPECT_GT(diagnosis.explanations.front().probability, 0.9);
}

TEST(Judgement, WhatIsInTheSetIsNotExcluded) {
  std::size_t members = 0;
  for (std::uint64_t n = 0; n < 400; ++n) {
    const auto between = [&](std::uint64_t k) { return 0.6 * (random_uniform(5, 3 * n + k) - 0.5); };
    const auto diagnosis = judged({between(0), between(1), between(2)});
    for (const auto& e : diagnosis.explanations)
      if (std::count(diagnosis.ambiguity_set.begin(), diagnosis.ambiguity_set.end(), e.id)) {
        EXPECT_FALSE(e.excluded) << e.id << " " << n << " " << e.probability;
        ++members;
      }
  }
  EXPECT_GT(members, 400U);
}

TEST(Judgement, EffectsThatLookAlikeAreASet) {
  Problem problem = planted({-0.4, 0.0, 0.0});
  problem.readings.signatures[0].powers = {Eigen::Vector3d(-2.0, 0.0, 0.0)};
  Diagnosis diagnosis;
  judge(problem, {}, {}, one_curve(), diagnosis);
  for (const char* id : {"missing_bridges", "machine_compliance"})
    EXPECT_TRUE(std::count(diagnosis.ambiguity_set.begin(), diagnosis.ambiguity_set.end(), id)) << id;
}

TEST(Shrinkage, IsOneWhereTheGapIsGoneAndZeroWhereItStays) {
  const Gap gap = planted({-0.4, -0.2, -0.3}).landmarks.gap;
  const auto gone = shrinkage_of(gap, Eigen::Vector3d::Zero());
  EXPECT_EQ(gone.after, 0.0);
  EXPECT_EQ(gone.fraction, 1.0);
  const auto stays = shrinkage_of(gap, gap.values);
  EXPECT_NEAR(stays.fraction, 0.0, 1e-12);
  EXPECT_NEAR(stays.before, excess(gap), 1e-12);
  const auto half = shrinkage_of(gap, 0.5 * gap.values);
  EXPECT_NEAR(half.fraction, 0.5, 0.02);
  EXPECT_LT(half.interval_90.first, half.fraction);
  EXPECT_GT(half.interval_90.second, half.fraction);
}

TEST(Shrinkage, OfAGapWithinTheNoiseThereIsNothingToClose) {
  Gap gap = planted({-0.4, -0.2, -0.3}).landmarks.gap;
  EXPECT_FALSE(shrinkage_of(gap, Eigen::Vector3d::Zero()).nothing_to_close);
  // One sigma and a bit in each feature: larger than the noise is on average, and no larger than it may be.
  const Eigen::MatrixXd covariance = gap.covariance + gap.believed * gap.believed.transpose();
  const Eigen::MatrixXd lower = covariance.llt().matrixL();
  gap.values = 1.3 * lower * Eigen::Vector3d::Ones();
  const auto within = shrinkage_of(gap, Eigen::Vector3d::Zero());
  EXPECT_TRUE(within.nothing_to_close);
  EXPECT_GT(within.before, 0.0);
  EXPECT_EQ(within.fraction, 0.0);
  EXPECT_EQ(within.interval_90, std::pair(0.0, 0.0));
}

}  // namespace
}  // namespace pendular::diagnosis
