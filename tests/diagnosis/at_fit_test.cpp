#include "diagnosis/inference/at_fit.h"
#include "signatures.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

constexpr Eigen::Index kSpan = 6, kFeatures = 10;
constexpr int kRuns = 4;

/// Noise of one in ten features, of which effects span the first six.
ReducedSpace space_of(std::vector<Eigen::Index> exact = {}) {
  Gap gap;
  gap.values = Eigen::VectorXd::Zero(kFeatures);
  gap.covariance = Eigen::MatrixXd::Identity(kFeatures, kFeatures);
  gap.believed = Eigen::MatrixXd::Zero(kFeatures, 0);
  gap.exact = std::move(exact);
  std::vector<Signature> effects;
  for (Eigen::Index k = 0; k < kSpan; ++k)
    effects.push_back(test::signature(std::string(1, static_cast<char>('a' + k)),
                                      5.0 * Eigen::VectorXd::Unit(kFeatures, k), -1.0, 1.0, 1.0));
  return {gap, effects};
}

/// Runs that are off by this, and by noise of this standard deviation in every feature.
Eigen::MatrixXd runs_off_by(const Eigen::VectorXd& off, double noise) {
  Eigen::MatrixXd rows(kRuns, off.size());
  for (Eigen::Index r = 0; r < kRuns; ++r)
    for (Eigen::Index f = 0; f < off.size(); ++f)
      rows(r, f) =
          off[f] + noise * random_normal(11 + static_cast<std::uint64_t>(r), static_cast<std::uint64_t>(f));
  return rows;
}

// With noise that is alike in all directions the likeliest variance of the mean beyond it is |m|²/n − ν, so
// that the mean is drawn to zero by James and Stein's factor, 1 − n ν/|m|².
TEST(AtFit, MeansAreDrawnToZeroByJamesAndSteinsFactor) {
  const ReducedSpace space = space_of();
  const Eigen::MatrixXd rows = runs_off_by(1.5 * Eigen::VectorXd::Ones(kFeatures), 0.8);
  const Eigen::MatrixXd within = rows.leftCols(kSpan);
  const Eigen::RowVectorXd mean = within.colwise().mean();
  const double scatter = (within.rowwise() - mean).squaredNorm() / (kRuns - 1) / kSpan / kRuns;
  const double factor = 1.0 - kSpan * scatter / mean.squaredNorm();
  ASSERT_GT(factor, 0.5);
  ASSERT_LT(factor, 0.98);
  const AtFit found = at_fit("a", rows, {}, space);
  for (Eigen::Index f = 0; f < kSpan; ++f) {
    EXPECT_NEAR(found.beyond[f], factor * mean[f], 0.02 * std::fabs(mean[f])) << f;
    EXPECT_NEAR(found.error(f, f), factor * scatter, 0.02 * scatter) << f;
  }
}

TEST(AtFit, WhatIsWithinTheScatterIsNothing) {
  const ReducedSpace space = space_of();
  Eigen::MatrixXd rows = runs_off_by(Eigen::VectorXd::Zero(kFeatures), 1.0);
  rows.rowwise() -= 0.9 * rows.colwise().mean();
  EXPECT_EQ(at_fit("a", rows, {}, space).beyond.norm(), 0.0);
  EXPECT_EQ(at_fit("a", rows, {}, space).error.norm(), 0.0);
}

// Of an effect that draws, what draws differ by is known: a mean along it is no surprise, one across it is.
TEST(AtFit, DirectionsInWhichDrawsDifferCountLess) {
  const ReducedSpace space = space_of();
  const Eigen::MatrixXd rows = runs_off_by(2.0 * Eigen::VectorXd::Ones(kFeatures), 0.2);
  const Eigen::VectorXd along = space.reduced(Eigen::VectorXd::Unit(kFeatures, 0));
  const AtFit found = at_fit("a", rows, 100.0 * along * along.transpose(), space);
  EXPECT_LT(std::fabs(found.beyond[0]), 0.5);
  for (Eigen::Index f = 1; f < kSpan; ++f) EXPECT_NEAR(found.beyond[f], 2.0, 0.4) << f;
  EXPECT_GT(found.error(0, 0), 10.0 * found.error(1, 1));
}

TEST(AtFit, NothingIsLearntOutsideTheSpanOrOfExactFeatures) {
  const ReducedSpace space = space_of({2});
  const AtFit found = at_fit("a", runs_off_by(2.0 * Eigen::VectorXd::Ones(kFeatures), 0.2), {}, space);
  EXPECT_NEAR(found.beyond[0], 2.0, 0.4);
  EXPECT_NEAR(found.beyond[2], 0.0, 1e-9);
  EXPECT_NEAR(found.beyond.tail(kFeatures - kSpan).norm(), 0.0, 1e-9);
  EXPECT_NEAR(found.error.bottomRows(kFeatures - kSpan).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace pendular::diagnosis
