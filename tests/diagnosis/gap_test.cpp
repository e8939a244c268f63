#include "diagnosis/inference/gap.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cmath>

#include <fmt/format.h>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

std::vector<Feature> features(int count) {
  std::vector<Feature> all;
  for (int k = 0; k < count; ++k)
    all.push_back({"A", fmt::format("f{}", k), Scale::aggregate, true, 1.0, 0, 0});
  return all;
}

Gap gap_of(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
  return {values, covariance, 0.0, {}, Eigen::MatrixXd::Zero(values.size(), 0)};
}

TEST(Gap, ThresholdOfIndependentFeaturesIsSidaks) {
  const Eigen::MatrixXd noise = 0.01 * Eigen::MatrixXd::Identity(10, 10);
  const auto table =
      gap_table(features(10), std::vector<double>(10, 1.0), gap_of(Eigen::VectorXd::Zero(10), noise));
  // |z| with P = 1 − 0.95^(1/10): 2.80.
  EXPECT_NEAR(table.threshold, 2.80, 0.08);
  EXPECT_NEAR(table.noise_floor, 0.1, 1e-12);
  EXPECT_EQ(table.excess, 0.0);
}

TEST(Gap, FeaturesThatGoTogetherCountAsOne) {
  const Eigen::MatrixXd noise =
      Eigen::MatrixXd::Constant(10, 10, 1.0) + 1e-6 * Eigen::MatrixXd::Identity(10, 10);
  const auto table =
      gap_table(features(10), std::vector<double>(10, 1.0), gap_of(Eigen::VectorXd::Zero(10), noise));
  EXPECT_NEAR(table.threshold, 1.96, 0.08);
}

TEST(Gap, SharesAreOfWhatGoesWithAFeature) {
  Eigen::VectorXd values(3);
  values << -0.3, 0.1, 0.0;
  const auto table =
      gap_table(features(3), {1.35, 0.9, 1.0}, gap_of(values, 0.01 * Eigen::MatrixXd::Identity(3, 3)));
  EXPECT_NEAR(table.rows[0].share, 0.9, 1e-12);
  EXPECT_NEAR(table.rows[1].share, 0.1, 1e-12);
  EXPECT_NEAR(table.rows[0].z, 3.0, 1e-12);
  EXPECT_TRUE(table.rows[0].significant);
  EXPECT_FALSE(table.rows[1].significant);
  EXPECT_NEAR(table.excess, std::sqrt(10.0 / 3.0 - 1.0), 1e-12);
}

TEST(Gap, NoiseAloneIsRarelySignificant) {
  Eigen::MatrixXd mix(6, 6);
  for (int k = 0; k < 36; ++k) mix(k / 6, k % 6) = random_normal(3, static_cast<std::uint64_t>(k));
  const Eigen::MatrixXd covariance = mix * mix.transpose() + Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  int alarms = 0;
  const int rounds = 300;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    Eigen::VectorXd noise(6);
    for (int k = 0; k < 6; ++k) noise[k] = random_normal(40000 + round, static_cast<std::uint64_t>(k));
    const auto table =
        gap_table(features(6), std::vector<double>(6, 1.0), gap_of(factor * noise, covariance));
    bool any = false;
    for (const auto& row : table.rows) any |= row.significant;
    alarms += any;
  }
  EXPECT_NEAR(alarms, 0.05 * rounds, 3.0 * std::sqrt(0.05 * 0.95 * rounds));
}

}  // namespace
}  // namespace pendular::diagnosis
