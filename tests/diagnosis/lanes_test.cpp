#include "diagnosis/inference/lanes.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index size, std::uint64_t seed) {
  Eigen::MatrixXd matrix(size, size);
  std::uint64_t next = 0;
  for (auto& one : matrix.reshaped()) one = random_normal(seed, next++);
  return matrix;
}

class Lanes : public ::testing::TestWithParam<int> {
 protected:
  const Eigen::Index size = GetParam();
  const Eigen::MatrixXd root = random_matrix(size, 1), other = random_matrix(size, 2);
  const Eigen::MatrixXd first = root * root.transpose(), second = other * other.transpose();

  struct Solved {
    LaneNumbers half_log_determinants, squared;
  };
  /// In lane k: I + (k + 1) first + k second + k 0.1 I.
  Solved solve(std::size_t lanes, std::vector<Eigen::MatrixXd>& matrices) const {
    LaneFactors factors(size);
    LaneNumbers of_first{}, of_second{};
    std::vector<LaneNumbers> x(static_cast<std::size_t>(size));
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const auto k = static_cast<double>(lane);
      of_first[lane] = k + 1.0, of_second[lane] = k;
      factors.add_diagonal(lane, Eigen::VectorXd::Constant(size, 0.1 * k));
      matrices.push_back((1.0 + 0.1 * k) * Eigen::MatrixXd::Identity(size, size) + (k + 1.0) * first +
                         k * second);
      for (std::size_t row = 0; row < x.size(); ++row) x[row][lane] = std::sin(k + static_cast<double>(row));
    }
    factors.add(first, of_first), factors.add(second, of_second);
    factors.factor();
    std::vector<LaneNumbers> solved(x.size());
    return {factors.half_log_determinants(), factors.squared(x, solved)};
  }
};

// Another program's decomposition: Eigen's.
TEST_P(Lanes, DeterminantsAndDistancesAreThoseOfEigen) {
  std::vector<Eigen::MatrixXd> matrices;
  const Solved solved = solve(kLanes, matrices);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Eigen::LLT<Eigen::MatrixXd> expected(matrices[lane]);
    Eigen::VectorXd x(size);
    for (Eigen::Index row = 0; row < size; ++row) x[row] = std::sin(static_cast<double>(row) + lane);
    EXPECT_NEAR(solved.half_log_determinants[lane], expected.matrixLLT().diagonal().array().log().sum(),
                1e-10 * static_cast<double>(size));
    const double distance = expected.matrixL().solve(x).squaredNorm();
    EXPECT_NEAR(solved.squared[lane], distance, 1e-10 * distance);
  }
}

TEST_P(Lanes, ALaneDoesNotDependOnTheOthers) {
  std::vector<Eigen::MatrixXd> matrices;
  const Solved all = solve(kLanes, matrices), some = solve(3, matrices);
  for (std::size_t lane = 0; lane < 3; ++lane) {
    EXPECT_EQ(all.half_log_determinants[lane], some.half_log_determinants[lane]);
    EXPECT_EQ(all.squared[lane], some.squared[lane]);
  }
  EXPECT_EQ(some.half_log_determinants[3], 0.0);  // the identity
}

INSTANTIATE_TEST_SUITE_P(Sizes, Lanes, ::testing::Values(1, 2, 5, 8, 45));

}  // namespace
}  // namespace pendular::diagnosis
