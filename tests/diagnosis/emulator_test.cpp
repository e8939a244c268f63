#include "diagnosis/bank/emulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Emulator, FindsAQuadraticBesideMembersOfTheirOwn) {
  std::vector<DesignRun> runs;
  for (int member : {1, 2, 3}) runs.push_back({member, "", 0.0, Eigen::Vector2d(member, 10.0)});
  for (int level : {1, 2, 3}) {
    const double theta = 0.1 * level;
    runs.push_back({level, "e", theta, Eigen::Vector2d(level + 2.0 * theta - theta * theta, 10.0 - theta)});
  }
  const auto responses = fit_responses(runs, 2);
  const Signature* found = responses.find("e");
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at(0.25)[0], 2.0 * 0.25 - 0.0625, 1e-10);
  EXPECT_NEAR(found->at(0.25)[1], -0.25, 1e-10);
  EXPECT_NEAR(responses.offsets(1, 0), 2.0, 1e-10);
  EXPECT_NEAR(responses.between(0, 0), 1.0, 1e-10);  // of 1, 2, 3
  EXPECT_NEAR(responses.within.norm(), 0.0, 1e-12);
  EXPECT_NEAR(responses.dof, 1.0, 1e-12);
  EXPECT_FALSE(responses.find("other"));
}

TEST(Emulator, UsesWhatRunsShow) {
  // The second feature is seen at two magnitudes only; a third never with the effect: no response.
  std::vector<DesignRun> runs = {{1, "", 0.0, Eigen::Vector3d(0.0, 0.0, 5.0)}};
  for (double theta : {0.1, 0.2, 0.3})
    runs.push_back({1, "e", theta, Eigen::Vector3d(theta, theta < 0.25 ? 3.0 * theta : kNaN, kNaN)});
  const auto responses = fit_responses(runs, 3);
  const Signature& found = *responses.find("e");
  EXPECT_NEAR(found.at(0.1)[1], 0.3, 1e-10);
  EXPECT_EQ(found.at(0.2)[2], 0.0);
  EXPECT_NEAR(responses.offsets(0, 2), 5.0, 1e-10);
}

TEST(Emulator, ScatterIsThatOfTheNoise) {
  // Noise of sd 0.1 and 0.2 with a correlation of 0.6 on top of members that lie 0.3 apart (sd).
  std::vector<DesignRun> runs;
  const auto noisy = [&](int member, const std::string& id, double theta) {
    const std::uint64_t n = runs.size();
    const double a = random_normal(5, 2 * n), b = random_normal(5, 2 * n + 1);
    const double offset = 0.3 * random_normal(6, static_cast<std::uint64_t>(member));
    runs.push_back(
        {member, id, theta, Eigen::Vector2d(offset + theta + 0.1 * a, offset + 0.2 * (0.6 * a + 0.8 * b))});
  };
  for (int member = 0; member < 40; ++member) {
    noisy(member, "", 0.0);
    for (int effect = 0; effect < 6; ++effect)
      noisy(member, std::string(2, static_cast<char>('a' + effect)), 0.1 * (1 + member % 3));
  }
  const auto responses = fit_responses(runs, 2);
  // Of a run less its member's baseline: both have the noise.
  EXPECT_NEAR(responses.within(0, 0), 2.0 * 0.01, 0.005);
  EXPECT_NEAR(responses.within(1, 1), 2.0 * 0.04, 0.02);
  EXPECT_NEAR(responses.within(0, 1) / std::sqrt(responses.within(0, 0) * responses.within(1, 1)), 0.6, 0.1);
  EXPECT_NEAR(responses.between(0, 1), 0.09, 0.05);
  const auto scatter = scatter_of(responses);
  EXPECT_GT(scatter.dof, 30.0);
  // The noise of a run is already in what members differ by; the fit adds no more than a part of it.
  EXPECT_GT(scatter.covariance(0, 0), responses.between(0, 0));
  EXPECT_LT(scatter.covariance(0, 0), 1.05 * responses.between(0, 0) + responses.within(0, 0));
}

TEST(Emulator, WhatDrawsDifferByIsTheEffectsOwnAndNoScatter) {
  // Each run has a draw of its own, which grows with θ: sd 0.5 and 1 with a correlation of 0.8 at θ = 0.3.
  std::vector<DesignRun> runs;
  for (int member = 0; member < 6; ++member) runs.push_back({member, "", 0.0, Eigen::Vector2d(0.0, 0.0)});
  for (std::uint64_t n = 0; n < 300; ++n) {
    const double theta = 0.1 * static_cast<double>(1 + n % 3), a = random_normal(21, 2 * n),
                 b = random_normal(21, 2 * n + 1);
    runs.push_back(
        {static_cast<int>(n % 6), "e", theta,
         theta * Eigen::Vector2d(2.0, -1.0) + theta / 0.3 * Eigen::Vector2d(0.5 * a, 0.8 * a + 0.6 * b),
         true});
  }
  for (std::uint64_t n = 0; n < 12; ++n)
    runs.push_back(
        {static_cast<int>(n % 6), "steady", 0.1 * static_cast<double>(1 + n % 3), Eigen::Vector2d(0.1, 0.1)});
  const auto responses = fit_responses(runs, 2);
  const Signature& found = *responses.find("e");
  EXPECT_DOUBLE_EQ(found.drawn_at, 0.3);
  EXPECT_NEAR(found.draws(0, 0), 0.25, 0.06);
  EXPECT_NEAR(found.draws(1, 1), 1.0, 0.2);
  EXPECT_GT(found.draws(0, 1), 0.2);  // 0.4, drawn to the diagonal
  EXPECT_LT(found.draws(0, 1), 0.48);
  EXPECT_NEAR(found.at(0.3)[0], 0.6, 0.1);
  EXPECT_LT(responses.find("steady")->draws.norm(), 0.01);
  EXPECT_LT(responses.within.norm(), 0.01);  // of the draws nothing is in the scatter
}

TEST(Emulator, WhatDrawsDifferByIsNotBlownUpBySmallMagnitudes) {
  // Draws differ by 0.2 θ beside a scatter of 0.1, at sixths of the range.
  std::vector<DesignRun> runs;
  for (int member = 0; member < 60; ++member)
    runs.push_back({member, "", 0.0, Eigen::VectorXd::Constant(1, 0.0)});
  for (int k = 0; k < 600; ++k) {
    const auto n = static_cast<std::uint64_t>(k);
    const double theta = (1 + k % 6) / 6.0;
    const double value = theta + 0.2 * theta * random_normal(8, n) + 0.1 * random_normal(9, n);
    runs.push_back({k % 60, "drawn", theta, Eigen::VectorXd::Constant(1, value), true});
    runs.push_back(
        {k % 60, "plain", theta, Eigen::VectorXd::Constant(1, theta + 0.1 * random_normal(10, n))});
  }
  const auto responses = fit_responses(runs, 1);
  EXPECT_NEAR(std::sqrt(responses.find("drawn")->draws(0, 0)), 0.2, 0.03);
  EXPECT_LT(std::sqrt(responses.find("plain")->draws(0, 0)), 0.05);
}

TEST(Emulator, FollowsASizeFromSmallMagnitudesOn) {
  // The logarithm of a size whose square grows with θ² from 0.03² on.
  const auto size = [](double theta) { return 0.5 * std::log1p(std::pow(theta / 0.03, 2)); };
  std::vector<DesignRun> runs;
  for (int member : {1, 2}) runs.push_back({member, "", 0.0, Eigen::VectorXd::Constant(1, 0.0)});
  for (double theta : {0.06, 1.0 / 3.0, 2.0 / 3.0, 1.0})
    for (int member : {1, 2})
      runs.push_back({member, "e", theta, Eigen::VectorXd::Constant(1, size(theta)), true});
  const auto responses = fit_responses(runs, 1);
  for (double theta : {0.04, 0.1, 0.2, 0.5, 0.9})
    EXPECT_NEAR(responses.find("e")->at(theta)[0], size(theta), 0.15) << theta;
}

TEST(Emulator, FindsHowWhatDrawsDifferByGrows) {
  // The number of bridges that are missing varies by the root of how many they are, a rotation by itself.
  for (const double growth : {1.0, 2.0}) {
    std::vector<DesignRun> runs;
    for (int member = 0; member < 6; ++member) runs.push_back({member, "", 0.0, Eigen::VectorXd::Zero(4)});
    for (int k = 0; k < 192; ++k) {
      const double theta = std::vector{0.06, 1.0 / 3.0, 2.0 / 3.0, 1.0}[static_cast<std::size_t>(k % 4)];
      Eigen::VectorXd drawn(4), plain(4);
      for (int f = 0; f < 4; ++f) {
        const auto n = static_cast<std::uint64_t>(4 * k + f);
        drawn[f] = std::pow(theta, 0.5 * growth) * random_normal(31, n) + 0.02 * random_normal(32, n);
        plain[f] = 0.02 * random_normal(33, n);
      }
      runs.push_back({k % 6, "drawn", theta, drawn, true});
      runs.push_back({k % 6, "plain", theta, plain});
    }
    const auto responses = fit_responses(runs, 4);
    const Signature& found = *responses.find("drawn");
    EXPECT_DOUBLE_EQ(found.growth, growth);
    EXPECT_NEAR(found.grown(0.25), std::pow(0.25, growth), 1e-12);
    EXPECT_NEAR(found.draws.trace() / 4.0, 1.0, 0.2);
  }
}

TEST(Emulator, WhatFewRunsAreMissedByIsNoMoreThanTheirSquaresSay) {
  // Six runs of effects that do nothing, and of one whose draws differ by three times the scatter, in forty
  // features.
  constexpr Eigen::Index kFeatures = 40;
  std::vector<DesignRun> runs;
  std::uint64_t next = 0;
  const auto scattered = [&](double times) {
    Eigen::VectorXd values(kFeatures);
    for (double& one : values) one = times * random_normal(41, next++);
    return values;
  };
  for (int member = 0; member < 12; ++member)
    runs.push_back({member, "", 0.0, Eigen::VectorXd::Zero(kFeatures)});
  for (int k = 0; k < 6; ++k) {
    const double theta = (k + 1) / 6.0;
    for (int effect = 0; effect < 20; ++effect)
      runs.push_back({k, std::string("e") + static_cast<char>('a' + effect), theta, scattered(1.0)});
    runs.push_back({k, "drawn", theta, scattered(3.0 * theta), true});
  }
  const auto responses = fit_responses(runs, kFeatures);
  double sum = 0.0, positive = 0.0;
  for (int effect = 0; effect < 20; ++effect) {
    const Signature& found = *responses.find(std::string("e") + static_cast<char>('a' + effect));
    const auto rows = static_cast<double>(found.missed.rows());
    sum += found.draws.trace();
    positive += positive_part(found.missed.transpose() * found.missed / rows - found.scatter).trace();
  }
  EXPECT_LT(sum, 0.8 * positive);
  EXPECT_GT(responses.find("drawn")->draws.trace(), 4.0 * sum / 20.0);
}

TEST(Emulator, CorrelationsOfMembersAreNotTrustedWhole) {
  Responses responses;
  responses.members = {1, 2};
  responses.between = Eigen::MatrixXd::Ones(6, 6);
  responses.within = Eigen::MatrixXd::Zero(6, 6);
  const auto scatter = scatter_of(responses);
  EXPECT_NEAR(scatter.dof, 1.0, 1e-12);
  EXPECT_NEAR(scatter.covariance(0, 1), 0.65 * 1.5, 1e-12);
  EXPECT_NEAR(scatter.covariance(0, 0), 1.5, 1e-12);
}

TEST(Emulator, EachSignHasAResponseOfItsOwnWhereRunsSaySo) {
  // Two to the one side, five to the other, as where bonds break but do not heal.
  std::vector<DesignRun> runs = {{1, "", 0.0, Eigen::VectorXd::Zero(1)}};
  for (const double theta : {-0.4, -0.2, 0.2, 0.4})
    for (const bool sided : {false, true})
      runs.push_back({1, sided ? "sided" : "smooth", theta,
                      Eigen::VectorXd::Constant(1, (theta < 0.0 ? 5.0 : 2.0) * theta), false, false, sided});
  const auto responses = fit_responses(runs, 1);
  const Signature &sided = *responses.find("sided"), &smooth = *responses.find("smooth");
  EXPECT_NEAR(sided.at(-0.3)[0], -1.5, 1e-12);
  EXPECT_NEAR(sided.at(0.3)[0], 0.6, 1e-12);
  EXPECT_FALSE(smooth.below);
  EXPECT_GT(std::fabs(smooth.at(-0.1)[0] + 0.5), 0.05);
}

}  // namespace
}  // namespace pendular::diagnosis
