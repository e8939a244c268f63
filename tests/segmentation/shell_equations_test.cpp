#include "segmentation/fit/shell_equations.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "segmentation/fit/ball_profile.h"

namespace pendular::segmentation {
namespace {

GreyBall sloping_ball() {
  GreyBall ball{Vec3::Zero(), 12.0, 20000.0, 10000.0};
  ball.contrast_slope = Vec3(30.0, -20.0, 10.0);
  ball.background_slope = Vec3(-5.0, 8.0, 12.0);
  return ball;
}

BallParameters off_start() {
  BallParameters q;
  q << 0.3, -0.2, 0.1, 12.2, 19000.0, 10300.0, 1.1;
  return q;
}

/// Voxels about the surface in directions by chance, with grey values by chance.
ShellVoxels some_voxels(std::size_t count) {
  ShellVoxels voxels;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 p =
        (10.0 + 4.0 * random_uniform(1, 5 * n + 3)) *
        Vec3(random_normal(1, 5 * n), random_normal(1, 5 * n + 1), random_normal(1, 5 * n + 2)).normalized();
    voxels.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
                      static_cast<float>(10000.0 + 20000.0 * random_uniform(1, 5 * n + 4))});
  }
  return voxels;
}

double rest(const ShellVoxel& voxel, const GreyBall& ball, const BallParameters& q) {
  const Vec3 p(voxel.x, voxel.y, voxel.z);
  const double profile = ball_profile((p - Vec3(q.head<3>())).norm(), q[3], q[6]).value;
  return voxel.grey - q[5] - ball.background_slope.dot(p) - (q[4] + ball.contrast_slope.dot(p)) * profile;
}

/// By central differences, with steps wider than those of the table.
BallParameters slopes(const ShellVoxel& voxel, const GreyBall& ball, const BallParameters& q) {
  BallParameters result;
  for (int k = 0; k < q.size(); ++k) {
    BallParameters low = q, high = q;
    const double step = k == 4 || k == 5 ? 1.0 : 0.01;
    low[k] -= step, high[k] += step;
    result[k] = (rest(voxel, ball, low) - rest(voxel, ball, high)) / (2.0 * step);
  }
  return result;
}

/// Numbers of voxels that fill registers and that do not.
class ShellSums : public testing::TestWithParam<std::size_t> {};

TEST_P(ShellSums, AreThoseOfSlopesByDifferences) {
  const GreyBall ball = sloping_ball();
  const BallParameters q = off_start();
  const ShellVoxels voxels = some_voxels(GetParam());
  ASSERT_EQ(voxels.size(), GetParam());
  NormalMatrix matrix = NormalMatrix::Zero();
  BallParameters right = BallParameters::Zero(), weighted = BallParameters::Zero();
  double squares = 0.0;
  VoxelNumbers weights(voxels);
  auto left = rests(voxels, ball, q);
  for (std::size_t n = 0; n < voxels.size(); ++n) {
    const BallParameters row = slopes(voxels[n], ball, q);
    const double expected = rest(voxels[n], ball, q);
    EXPECT_NEAR(left[n], expected, 1e-6);
    matrix += row * row.transpose();
    right += expected * row;
    squares += expected * expected;
    weights[n] = random_normal(2, n);
    weighted += weights[n] * row;
  }
  const Equations found = equations(voxels, ball, q, true);
  const BallParameters scale = matrix.diagonal().cwiseSqrt();
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) EXPECT_NEAR(found.matrix(i, j), matrix(i, j), 3e-4 * scale[i] * scale[j]);
    EXPECT_NEAR(found.right[i], right[i], 3e-4 * scale[i] * std::sqrt(squares));
    EXPECT_NEAR(weighted_slopes(voxels, ball, q, {weights})[0][i], weighted[i], 3e-3 * scale[i]);
  }
  EXPECT_NEAR(found.squares, squares, 1e-9 * squares);
}
INSTANTIATE_TEST_SUITE_P(Counts, ShellSums, testing::Values(1, 7, 8, 9, 64, 100));

TEST(ShellVoxels, KeepTheirOrderWhenSomeAreDropped) {
  ShellVoxels voxels = some_voxels(21);
  const ShellVoxels all = voxels;
  EXPECT_EQ(voxels.keep_if([](std::size_t n) { return n % 3 != 0; }), 7U);
  ASSERT_EQ(voxels.size(), 14U);
  for (std::size_t n = 0; n < voxels.size(); ++n) EXPECT_EQ(voxels[n].grey, all[n / 2 * 3 + n % 2 + 1].grey);
}

}  // namespace
}  // namespace pendular::segmentation
