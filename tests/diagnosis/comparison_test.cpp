#include "diagnosis/inference/comparison.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "diagnosis/bank/bank.h"
#include "diagnosis/kinds/kind.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

/// A curve, a gauge and a scan, of one feature each.
Experiment three_observations() {
  Experiment experiment;
  for (const Kind* kind : {&kinds::compression(), &kinds::lateral_strain(), &kinds::displacements()}) {
    Observation observation;
    observation.kind = kind, observation.name = kind->name;
    experiment.observations.push_back(observation);
  }
  return experiment;
}

/// Members at zero, with effects that change all three features in proportion to their magnitude.
Design changed_by(const std::vector<std::string>& effects) {
  Design design;
  for (std::size_t o = 0; o < 3; ++o) {
    Feature feature;
    feature.name = "f" + std::to_string(o);
    design.observed.features.push_back(feature), design.observed.observation.push_back(o);
  }
  design.observed.measurement = design.observed.model = 0.01 * Eigen::MatrixXd::Identity(3, 3);
  std::uint64_t draws = 0;
  for (int member = 1; member <= 6; ++member) {
    Eigen::VectorXd base(3);
    for (double& one : base) one = 0.1 * random_normal(7, draws++);
    design.runs.push_back({member, "", 0.0, base});
    design.whole.push_back(base);
    for (const auto& id : effects)
      for (const double theta : {1.0, 2.0})
        design.runs.push_back(
            {member, id, theta, base + theta * Eigen::Vector3d(1.0, 2.0, 3.0), false, true});
  }
  design.by_noise = Eigen::VectorXd::Zero(3);
  return design;
}

// A curve's strain is what the machine reads. That of a scan, or of a gauge as well, may be the specimen's
// own: then the machine's compliance does nothing there.
TEST(Comparison, AMisreadStrainMayBeTheCurvesAlone) {
  const Comparison found =
      compare(three_observations(), BankPlan{}, changed_by({"machine_compliance", "platen_tilt"}));
  ASSERT_EQ(found.signatures.size(), 2u);
  for (const auto& signature : found.signatures) {
    const bool misread = signature.id == "machine_compliance";
    ASSERT_EQ(signature.readings(), misread ? 3u : 1u) << signature.id;
    EXPECT_TRUE(signature.at(1.0).isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-9)) << signature.id;
    if (!misread) continue;
    EXPECT_TRUE(signature.response(1.0, 1).at(1.0).isApprox(Eigen::Vector3d(1.0, 2.0, 0.0), 1e-9));
    EXPECT_TRUE(signature.response(1.0, 2).at(1.0).isApprox(Eigen::Vector3d(1.0, 0.0, 0.0), 1e-9));
  }
}

// Responses to an effect and to what is believed are learnt apart; runs of both show what is not their sum.
TEST(Comparison, RunsAtAFitTellWhatResponsesDoNotAddUpTo) {
  const Eigen::Vector3d effect(1.0, 2.0, 3.0), input(-0.3, 0.3, 0.6);
  Experiment experiment = three_observations();
  experiment.uncertainty = {{"contact.friction", 0.05}};
  Design design = changed_by({"platen_tilt"});
  design.observed.level = Level::readings;
  const auto whole = design.whole;
  for (std::size_t m = 0; m < whole.size(); ++m) {
    const int member = static_cast<int>(m) + 1;
    for (const double sds : {-2.0, -1.0, 1.0, 2.0})
      design.runs.push_back({member, "contact.friction", sds, whole[m] + sds * input});
    if (member > 4) continue;
    Eigen::VectorXd run = whole[m] + 1.5 * effect - 2.0 * input + 0.7 * effect;
    for (Eigen::Index f = 0; f < 3; ++f)
      run[f] += 1e-3 * random_normal(9, static_cast<std::uint64_t>(3 * member + f));
    design.at_fit.push_back(
        {{member, "platen_tilt", 1.0, run}, {{"platen_tilt", 1.5}, {"contact.friction", -2.0}}});
  }
  const Comparison found = compare(experiment, BankPlan{}, design);
  ASSERT_EQ(found.gap.at_fit.size(), 1u);
  EXPECT_EQ(found.gap.at_fit[0].id, "platen_tilt");
  EXPECT_TRUE(found.gap.at_fit[0].beyond.isApprox(0.7 * effect, 0.02)) << found.gap.at_fit[0].beyond;
  // What is left of the gap counts it.
  const Eigen::VectorXd left = left_by(found, {{"platen_tilt", {1.5, {1.4, 1.6}}}});
  EXPECT_TRUE((found.gap.values - left).isApprox(2.2 * effect, 0.02));
  design.at_fit.resize(2);  // too few to tell
  EXPECT_TRUE(compare(experiment, BankPlan{}, design).gap.at_fit.empty());
}

// Two readings of the law are as likely: of what the other one does to members, half the variance is noise.
TEST(Comparison, WhatALawDoesToOneMemberMoreThanToAnotherIsNoise) {
  const Eigen::Vector3d law(0.2, 0.4, -0.1), differs(0.3, -0.1, 0.2), input(-0.3, 0.3, 0.6);
  Experiment experiment = three_observations();
  experiment.uncertainty = {{"contact.friction", 0.05}};
  const auto widened_by = [&](double differing) {
    Design design = changed_by({"platen_tilt"});
    const auto whole = design.whole;
    for (std::size_t m = 0; m < whole.size(); ++m) {
      const int member = static_cast<int>(m) + 1;
      for (int sds = -10; sds <= 10; ++sds)
        if (sds != 0)
          design.runs.push_back({member, "contact.friction", 0.2 * sds, whole[m] + 0.2 * sds * input});
      const double more = m % 2 == 0 ? differing : -differing;  // ± of six: variance 6/5
      design.runs.push_back({member, "glass", 1.0, whole[m] + law + more * differs});
    }
    const Eigen::MatrixXd before = design.observed.model;
    return Eigen::MatrixXd(compare(experiment, BankPlan{}, design).observed.model - before);
  };
  EXPECT_LT(widened_by(0.0).norm(), 1e-6);
  const Eigen::MatrixXd widened = widened_by(1.0), expected = 0.5 * differs * differs.transpose();
  EXPECT_GT(widened.trace(), 0.9 * expected.trace());
  EXPECT_LT(widened.trace(), 1.5 * expected.trace());
  EXPECT_TRUE((widened / widened.trace()).isApprox(expected / expected.trace(), 0.05)) << widened;
}

}  // namespace
}  // namespace pendular::diagnosis
