#include "dem_core/linear/stiffness_sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace pendular {
namespace {

constexpr double kTolerance = 1e-12;

/// Beads about a lattice between two platens, each joined to those near it.
dem_core::SpringNetwork random_network() {
  constexpr int kSide = 4;
  std::vector<Vec3> at;
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) {
        const auto k = static_cast<std::uint64_t>(at.size());
        at.emplace_back(x + 0.2 * random_normal(1, 3 * k), y + 0.2 * random_normal(1, 3 * k + 1),
                        z + 0.2 * random_normal(1, 3 * k + 2));
      }
  const int beads = static_cast<int>(at.size());
  std::vector<dem_core::NetworkSpring> springs;
  const auto add = [&](int i, int j, const Vec3& n, double arm_j) {
    const auto k = static_cast<std::uint64_t>(springs.size());
    springs.push_back({i, j, n, 1.1, arm_j, 1.0 + random_uniform(2, 4 * k),
                       0.2 + random_uniform(2, 4 * k + 1), 0.05, 0.03, 0.1 * random_normal(2, 4 * k + 3)});
  };
  for (int i = 0; i < beads; ++i) {
    for (int j = i + 1; j < beads; ++j)
      if (const Vec3 way = at[i] - at[j]; way.norm() < 1.5) add(i, j, way.normalized(), 0.9);
    if (at[i].z() < 0.5) add(i, beads, Vec3::UnitZ(), 0.0);
    if (at[i].z() > 2.5) add(i, beads + 1, -Vec3::UnitZ(), 0.0);
  }
  return {std::vector<double>(at.size() + 2, 0.5), springs};
}

dem_core::NodeVector solved(const dem_core::SpringNetwork& network) {
  dem_core::NodeVector x = dem_core::NodeVector::Zero(6 * network.nodes());
  x[6 * network.bottom() + 2] = 0.3;
  solve(network, network.pushes(), kTolerance, x);
  return x;
}

/// The springs made stiffer by exp θ, their pushes with them.
dem_core::SpringNetwork stiffened(const dem_core::SpringNetwork& network, const std::vector<double>& theta) {
  auto springs = network.springs();
  for (std::size_t b = 0; b < springs.size(); ++b) {
    const double factor = std::exp(theta[b]);
    springs[b].normal *= factor, springs[b].tangential *= factor;
    springs[b].bend *= factor, springs[b].twist *= factor, springs[b].push *= factor;
  }
  return network.with(springs);
}

std::vector<double> one_of(const dem_core::SpringNetwork& network, std::size_t spring, double value) {
  std::vector<double> theta(network.springs().size(), 0.0);
  theta[spring] = value;
  return theta;
}

TEST(StiffnessSensitivity, IsTheFiniteDifference) {
  const dem_core::SpringNetwork network = random_network();
  const dem_core::NodeVector x = solved(network);
  constexpr double kStep = 1e-4;
  for (std::size_t spring : {std::size_t{3}, std::size_t{77}, network.springs().size() - 1}) {
    const dem_core::NodeVector exact =
        dem_core::stiffness_sensitivity(network, x, one_of(network, spring, 1.0), kTolerance);
    const dem_core::NodeVector difference = (solved(stiffened(network, one_of(network, spring, kStep))) -
                                             solved(stiffened(network, one_of(network, spring, -kStep)))) /
                                            (2.0 * kStep);
    EXPECT_LT((exact - difference).norm(), 1e-5 * difference.norm()) << spring;
  }
}

TEST(StiffnessSensitivity, AdjointGradientIsThatOfTheMisfitForEverySpring) {
  const dem_core::SpringNetwork network = random_network();
  const dem_core::NodeVector x = solved(network);
  dem_core::NodeVector seen = x;
  for (Eigen::Index k = 0; k < 6 * network.free_nodes(); ++k)
    seen[k] += k % 6 < 3 ? 0.01 * random_normal(3, static_cast<std::uint64_t>(k)) : 0.0;
  const auto misfit = [&](const dem_core::NodeVector& moved) { return 0.5 * (moved - seen).squaredNorm(); };
  const auto gradient = dem_core::stiffness_gradient(network, x, x - seen, kTolerance);
  ASSERT_EQ(gradient.size(), network.springs().size());
  constexpr double kStep = 1e-4;
  for (std::size_t spring = 0; spring < gradient.size(); spring += 17) {
    const double difference = (misfit(solved(stiffened(network, one_of(network, spring, kStep)))) -
                               misfit(solved(stiffened(network, one_of(network, spring, -kStep))))) /
                              (2.0 * kStep);
    EXPECT_NEAR(gradient[spring], difference, 1e-4 * std::fabs(difference) + 1e-9) << spring;
  }
}

}  // namespace
}  // namespace pendular
