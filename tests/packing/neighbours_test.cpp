#include "packing/neighbours.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace pendular {
namespace {

struct Cloud {
  std::vector<Vec3> centres;
  std::vector<double> diameters;
};

Cloud random_cloud(std::size_t count, const Vec3& extent, std::uint64_t seed) {
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 u(random_uniform(seed, 4 * k), random_uniform(seed, 4 * k + 1),
                 random_uniform(seed, 4 * k + 2));
    cloud.centres.push_back(u.cwiseProduct(extent) - 0.3 * extent);
    cloud.diameters.push_back(0.5 + random_uniform(seed, 4 * k + 3));
  }
  return cloud;
}

std::vector<IndexPair> by_brute_force(const Cloud& cloud, double max_gap) {
  std::vector<IndexPair> pairs;
  const int count = static_cast<int>(cloud.centres.size());
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if ((cloud.centres[i] - cloud.centres[j]).norm() - 0.5 * (cloud.diameters[i] + cloud.diameters[j]) <
          max_gap)
        pairs.emplace_back(i, j);
  return pairs;
}

struct Case {
  const char* name;
  std::size_t count;
  Vec3 extent;
  double max_gap;
};

class Neighbours : public ::testing::TestWithParam<Case> {};

TEST_P(Neighbours, AgreeWithBruteForce) {
  const auto& [name, count, extent, max_gap] = GetParam();
  const Cloud cloud = random_cloud(count, extent, 7);
  const auto expected = by_brute_force(cloud, max_gap);
  EXPECT_EQ(pairs_within(cloud.centres, cloud.diameters, max_gap), expected);
  EXPECT_FALSE(expected.empty());
}

// Each pair is found from the larger of its two spheres; equal ones are found once.
TEST(NeighboursOfMany, AFewLargeSpheresAmongEqualOnes) {
  Cloud cloud = random_cloud(1200, {10, 10, 10}, 3);
  for (std::size_t k = 0; k < cloud.diameters.size(); ++k) cloud.diameters[k] = k % 50 == 0 ? 4.0 : 0.8;
  EXPECT_EQ(pairs_within(cloud.centres, cloud.diameters, 0.05), by_brute_force(cloud, 0.05));
}

INSTANTIATE_TEST_SUITE_P(
    All, Neighbours,
    ::testing::Values(Case{"touching", 1500, {9, 9, 9}, 0.0}, Case{"gap", 1500, {12, 8, 9}, 0.4},
                      Case{"overlap", 1500, {8, 8, 8}, -0.3}, Case{"wide", 300, {1e4, 2, 2}, 80.0},
                      Case{"sparse", 400, {3e5, 3e5, 3e5}, 2e4}, Case{"flat", 800, {20, 20, 0}, 0.1},
                      Case{"all", 60, {5, 5, 5}, 100.0}),
    [](const auto& entry) { return entry.param.name; });

TEST(NeighboursOfFew, NoneOfNothingOrOfOne) {
  EXPECT_TRUE(pairs_within({}, {}, 1.0).empty());
  const Cloud one = random_cloud(1, {1, 1, 1}, 1);
  EXPECT_TRUE(pairs_within(one.centres, one.diameters, 1.0).empty());
  const Cloud many = random_cloud(100, {3, 3, 3}, 1);
  EXPECT_TRUE(
      pairs_within(many.centres, many.diameters, -2.0).empty());  // no overlap can be deeper than a diameter
}

}  // namespace
}  // namespace pendular
