#include "segmentation/fit/ball_fit.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <vector>

#include "base/quantile.h"
#include "segmentation/fit/shell.h"
#include "segmentation/fit/shell_equations.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

/// What errors of the known grey values add to the parameters' covariance: each shifts them by N⁻¹ Jᵀ e.
NormalMatrix covariance_of(const std::vector<GreyAt>& errors, const ShellVoxels& voxels, const GreyBall& ball,
                           const BallParameters& q, const NormalMatrix& inverse) {
  if (errors.empty()) return NormalMatrix::Zero();
  std::vector<VoxelNumbers> at_voxels(errors.size(), VoxelNumbers(voxels));
  for (std::size_t n = 0; n < voxels.size(); ++n) {
    const ShellVoxel voxel = voxels[n];
    const Vec3 p = ball.centre + Vec3(voxel.x, voxel.y, voxel.z);
    for (std::size_t m = 0; m < errors.size(); ++m) at_voxels[m][n] = errors[m](p);
  }
  NormalMatrix covariance = NormalMatrix::Zero();
  for (BallParameters sums : weighted_slopes(voxels, ball, q, at_voxels)) {
    sums[6] = 0.0;  // The blur is not free where grey values are known.
    const BallParameters shift = inverse * sums;
    covariance += shift * shift.transpose();
  }
  return covariance;
}

bool plausible(const BallParameters& q, double radius, double contrast) {
  return q.allFinite() && q.head<3>().norm() < 0.7 * radius && q[3] > 0.4 * radius && q[3] < 2.0 * radius &&
         q[6] > 0.1 && q[6] < 0.5 * radius && std::abs(q[4]) < 3.0 * std::abs(contrast);
}

struct Solution {
  BallParameters q;
  Equations equations;
  bool converged = false;
};

Solution solved(const ShellVoxels& voxels, const GreyBall& start, const BallParameters& from,
                const FitSetting& setting) {
  Solution now{from, equations(voxels, start, from, setting.fit_blur)};
  double damping = 1e-3;
  for (int iteration = 0; iteration < setting.iterations && !now.converged && damping < 1e8; ++iteration) {
    NormalMatrix damped = now.equations.matrix;
    damped.diagonal() *= 1.0 + damping;
    const BallParameters step = damped.ldlt().solve(now.equations.right);
    const BallParameters next = now.q + step;
    if (!plausible(next, start.radius, start.contrast)) {
      damping *= 10.0;
      continue;
    }
    now.converged = step.head<4>().norm() < setting.tolerance;
    const Equations then = equations(voxels, start, next, setting.fit_blur);
    if (then.squares > now.equations.squares) {
      damping *= 10.0;
      continue;
    }
    now.q = next;
    now.equations = then;
    damping *= 0.1;
  }
  return now;
}

constexpr std::size_t patches_along = 4, patches = 6 * patches_along * patches_along;

/// Of the sphere's patches, squares on the faces of a cube about it, which share each quarter turn evenly,
/// the one in a direction.
std::size_t patch_of(const Vec3& p) {
  static_assert(patches_along == 4);
  constexpr double middle = M_SQRT2 - 1.0;  // tangent of an eighth of a half turn
  Eigen::Index axis;
  const double most = p.cwiseAbs().maxCoeff(&axis);
  const auto place = [&](double along) -> std::size_t {
    return (along >= -middle * most) + (along >= 0.0) + (along >= middle * most);
  };
  const auto face = static_cast<std::size_t>(2 * axis + (p[axis] > 0.0 ? 1 : 0));
  return (face * patches_along + place(p[(axis + 1) % 3])) * patches_along + place(p[(axis + 2) % 3]);
}

/// Drops the voxels of patches in which the mean of what is left, within the ball or around it, is further
/// from zero than means of patches are: something that is not known is there. Whether there were any.
bool drop_foreign(ShellVoxels& voxels, const GreyBall& start, const BallParameters& q) {
  constexpr double to_sd = 1.4826;
  std::array<double, 2 * patches> sum{}, count{};
  std::vector<std::size_t> cells(voxels.size());
  auto rest = rests(voxels, start, q);
  for (std::size_t n = 0; n < voxels.size(); ++n) {
    const ShellVoxel voxel = voxels[n];
    const Vec3 p(voxel.x - q[0], voxel.y - q[1], voxel.z - q[2]);
    cells[n] = 2 * patch_of(p) + (p.norm() > q[3] ? 1 : 0);
    sum[cells[n]] += rest[n];
    count[cells[n]] += 1.0;
  }
  std::vector<double> scores;
  for (std::size_t cell = 0; cell < sum.size(); ++cell)
    if (count[cell] > 0.0) scores.push_back(std::abs(sum[cell]) / std::sqrt(count[cell]));
  const double most = kThresholds.foreign_patch * to_sd * median(scores);
  std::array<bool, patches> foreign{};
  for (std::size_t cell = 0; cell < sum.size(); ++cell)
    if (count[cell] > 0.0 && std::abs(sum[cell]) / std::sqrt(count[cell]) > most) foreign[cell / 2] = true;
  return voxels.keep_if([&](std::size_t n) { return !foreign[cells[n] / 2]; }) > 0;
}

}  // namespace

BallFit fit_ball(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                 std::span<const Neighbour> neighbours, const std::optional<Container>& container,
                 const FitSetting& setting, const KnownGrey& known) {
  const GreyBall& start = balls[own];
  Shell shell = shell_about(volume, balls, own, neighbours, container, setting, known.grey);
  BallFit fit{start, setting.blur, 0.0, 0.0, 0.0, shell.free_share, 1.0, false};
  constexpr std::size_t least_voxels = 50;
  if (shell.voxels.size() < least_voxels) return fit;

  BallParameters from;
  from << 0.0, 0.0, 0.0, start.radius, start.contrast, start.background, setting.blur;
  Solution solution = solved(shell.voxels, start, from, setting);
  const double all = static_cast<double>(shell.voxels.size());
  constexpr int most_turns = 3;
  for (int turn = 0; setting.drop_foreign && turn < most_turns; ++turn) {
    if (!drop_foreign(shell.voxels, start, solution.q)) break;
    if (shell.voxels.size() < least_voxels) return fit;
    solution = solved(shell.voxels, start, solution.q, setting);
  }
  const auto& [q, now, converged] = solution;
  fit.converged = converged;
  fit.explained_share = static_cast<double>(shell.voxels.size()) / all;
  const double n = static_cast<double>(shell.voxels.size());
  const double variance = now.squares / (n - 6.0);
  const NormalMatrix inverse = now.matrix.ldlt().solve(NormalMatrix::Identity());
  const NormalMatrix covariance =
      variance * inverse + covariance_of(known.errors, shell.voxels, start, q, inverse);
  const Vec3 shift = q.head<3>();
  fit.ball = {start.centre + shift,
              q[3],
              q[4] + start.contrast_slope.dot(shift),
              q[5] + start.background_slope.dot(shift),
              start.contrast_slope,
              start.background_slope};
  fit.blur = q[6];
  fit.sigma_centre = std::sqrt(covariance.diagonal().head<3>().sum() / 3.0);
  fit.sigma_radius = std::sqrt(covariance(3, 3));
  fit.residual = std::sqrt(variance);
  fit.converged = fit.converged && std::isfinite(fit.sigma_centre) && std::isfinite(fit.sigma_radius);
  return fit;
}

}  // namespace pendular::segmentation
