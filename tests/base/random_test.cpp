#include "base/random.h"

#include <gtest/gtest.h>

namespace pendular {
namespace {

TEST(Random, NormalHasTheMomentsOfANormal) {
  const int n = 200000;
  double sum = 0.0, square = 0.0, fourth = 0.0, lag = 0.0;
  for (int k = 0; k < n; ++k) {
    const double x = random_normal(7, static_cast<std::uint64_t>(k));
    sum += x, square += x * x, fourth += x * x * x * x;
    lag += x * random_normal(7, static_cast<std::uint64_t>(k) + 1);
  }
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(square / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3.0, 5.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(lag / n, 0.0, 5.0 / std::sqrt(n));
}

TEST(Random, SeedsAreIndependent) {
  const int n = 100000;
  double both = 0.0;
  for (int k = 0; k < n; ++k)
    both += (random_uniform(1, static_cast<std::uint64_t>(k)) - 0.5) *
            (random_uniform(2, static_cast<std::uint64_t>(k)) - 0.5);
  EXPECT_NEAR(both / n, 0.0, 5.0 / 12.0 / std::sqrt(n));
}

}  // namespace
}  // namespace pendular
