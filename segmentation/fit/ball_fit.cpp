#include "segmentation/fit/ball_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantile.h"
#include "segmentation/fit/ball_profile.h"
#include "segmentation/fit/rings.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

/// A voxel of a shell, relative to the ball's first centre.
struct ShellVoxel {
  float x, y, z, grey;
};

struct Shell {
  std::vector<ShellVoxel> samples;
  double free_share = 0.0;
};

/// What hides a shell: the cones and bodies of the neighbours, and the container.
class Hidden {
 public:
  /// `margin` about the neighbours.
  Hidden(std::span<const GreyBall> balls, std::size_t own, std::span<const Neighbour> neighbours,
         const std::optional<Container>& container, const FitSetting& setting, double margin)
      : centre_(balls[own].centre),
        container_(container ? &*container : nullptr),
        margin_(setting.half_width) {
    const double sine = std::min(0.95, setting.cone / balls[own].radius),
                 cosine = std::sqrt(1.0 - sine * sine);
    for (const Neighbour& other : neighbours) {
      const GreyBall& ball = balls[other.ball];
      const Vec3 to = ball.centre - centre_;
      const double distance = to.norm();
      const double reach = ball.radius + margin;
      bodies_.push_back({to, reach * reach, to / distance, other.polymer ? cosine : 2.0});
    }
    if (container && free_of(*container, balls[own].radius + 2.0 * margin_)) container_ = nullptr;
  }

  /// `p` relative to the ball's centre, at distance r from it.
  bool operator()(const Vec3& p, double r) const {
    for (const Body& body : bodies_)
      if (p.dot(body.direction) > body.cosine * r || (p - body.to).squaredNorm() < body.reach_squared)
        return true;
    if (!container_) return false;
    const double z = centre_.z() + p.z();
    return std::hypot(centre_.x() + p.x() - container_->axis_x, centre_.y() + p.y() - container_->axis_y) >
               container_->radius - margin_ ||
           (container_->bottom && z < *container_->bottom + margin_) ||
           (container_->top && z > *container_->top - margin_);
  }

 private:
  /// Whether the container is further than `reach` from the centre.
  bool free_of(const Container& container, double reach) const {
    return std::hypot(centre_.x() - container.axis_x, centre_.y() - container.axis_y) + reach <
               container.radius &&
           !(container.bottom && centre_.z() < *container.bottom + reach) &&
           !(container.top && centre_.z() > *container.top - reach);
  }

  struct Body {
    Vec3 to;
    double reach_squared;
    Vec3 direction;
    double cosine;  ///< of the cone's half-angle; above 1: no cone
  };
  Vec3 centre_;
  std::vector<Body> bodies_;
  const Container* container_;  ///< none where it is out of reach
  double margin_;               ///< about the container
};

template <typename T>
Shell shell_of(std::span<const T> pixels, const Volume& volume, const GreyBall& ball, const Hidden& hidden,
               const FitSetting& setting, const GreyAt& known) {
  constexpr double inwards =
      3.0;  // at least: within the ball there is nothing else, and its level is to be seen
  const double inner = std::max(0.5, ball.radius - std::max(inwards, setting.half_width)),
               outer = ball.radius + setting.half_width;
  std::array<long, 3> low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = static_cast<long>(std::ceil(ball.centre[axis] - outer));
    high[axis] = static_cast<long>(std::floor(ball.centre[axis] + outer));
  }
  Shell shell;
  std::size_t all = 0, free = 0;
  const auto inside = [&](long k, int axis) { return k >= 0 && k < static_cast<long>(volume.size[axis]); };
  for (long k = low[2]; k <= high[2]; ++k)
    for (long j = low[1]; j <= high[1]; ++j) {
      const double y = static_cast<double>(j) - ball.centre.y(), z = static_cast<double>(k) - ball.centre.z();
      const double within = outer * outer - y * y - z * z, chord = inner * inner - y * y - z * z;
      if (within < 0.0) continue;
      const double half = std::sqrt(within) + 0.5;                       // of the row, a little wide
      const double hollow = chord > 1.0 ? std::sqrt(chord) - 0.5 : 0.0;  // a little narrow
      const long end = std::min(high[0], static_cast<long>(std::floor(ball.centre.x() + half)));
      for (long i = std::max(low[0], static_cast<long>(std::ceil(ball.centre.x() - half))); i <= end; ++i) {
        const Vec3 p(static_cast<double>(i) - ball.centre.x(), y, z);
        if (std::fabs(p.x()) < hollow) {
          i = static_cast<long>(std::floor(ball.centre.x() + hollow));
          continue;
        }
        const double square = p.squaredNorm();
        if (square < inner * inner || square > outer * outer || all++ % setting.stride != 0) continue;
        if (!inside(i, 0) || !inside(j, 1) || !inside(k, 2) || hidden(p, std::sqrt(square))) continue;
        double grey = grey_at(pixels, volume, setting.rings, i, j, k);
        if (std::isnan(grey)) continue;
        ++free;
        if (known) grey -= known(ball.centre + p);
        shell.samples.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                 static_cast<float>(p.z()), static_cast<float>(grey)});
      }
    }
  shell.free_share = all ? static_cast<double>(free * setting.stride) / static_cast<double>(all) : 0.0;
  return shell;
}

// Order of the parameters: centre (relative to the shell's), radius, contrast, background, blur.
using Parameters = Eigen::Matrix<double, 7, 1>;
using Normal = Eigen::Matrix<double, 7, 7>;

/// Sums of the normal equations of the least-squares problem at `q`.
struct Equations {
  Normal matrix = Normal::Zero();
  Parameters right = Parameters::Zero();
  double squares = 0.0;
};

/// A voxel's slopes with respect to the parameters, and what is left of its grey value.
Eigen::Matrix<double, 8, 1> slopes_and_rest(const ShellVoxel& voxel, const GreyBall& ball,
                                            const Parameters& q) {
  const double dx = voxel.x - q[0], dy = voxel.y - q[1], dz = voxel.z - q[2];
  const double r = std::sqrt(dx * dx + dy * dy + dz * dz);
  const BallProfile profile = ball_profile(r, q[3], q[6]);
  const Vec3 p(voxel.x, voxel.y, voxel.z);
  const double contrast = q[4] + ball.contrast_slope.dot(p), background = q[5] + ball.background_slope.dot(p);
  const double pull = -contrast * profile.by_distance / r;
  Eigen::Matrix<double, 8, 1> row;
  row << pull * dx, pull * dy, pull * dz, contrast * profile.by_radius, profile.value, 1.0,
      contrast * profile.by_blur, voxel.grey - background - contrast * profile.value;
  return row;
}

Equations equations(const std::vector<ShellVoxel>& voxels, const GreyBall& ball, const Parameters& q,
                    bool fit_blur) {
  constexpr std::size_t block = 128;  // a product of matrices is quicker than one of vectors for each voxel
  Eigen::Matrix<double, 8, block> rows;
  Eigen::Matrix<double, 8, 8> sums = Eigen::Matrix<double, 8, 8>::Zero();
  for (std::size_t first = 0; first < voxels.size(); first += block) {
    const std::size_t count = std::min(block, voxels.size() - first);
    for (std::size_t k = 0; k < count; ++k)
      rows.col(static_cast<Eigen::Index>(k)) = slopes_and_rest(voxels[first + k], ball, q);
    const auto filled = rows.leftCols(static_cast<Eigen::Index>(count));
    sums.noalias() += filled * filled.transpose();
  }
  Equations result{sums.topLeftCorner<7, 7>(), sums.col(7).head<7>(), sums(7, 7)};
  if (!fit_blur) {
    result.matrix.row(6).setZero(), result.matrix.col(6).setZero();
    result.matrix(6, 6) = 1.0, result.right[6] = 0.0;
  }
  return result;
}

/// What errors of the known grey values add to the parameters' covariance: each shifts them by N⁻¹ Jᵀ e.
Normal covariance_of(const std::vector<GreyAt>& errors, const std::vector<ShellVoxel>& voxels,
                     const GreyBall& ball, const Parameters& q, const Normal& inverse) {
  if (errors.empty()) return Normal::Zero();
  Eigen::Matrix<double, 7, Eigen::Dynamic> sums =
      Eigen::Matrix<double, 7, Eigen::Dynamic>::Zero(7, static_cast<Eigen::Index>(errors.size()));
  for (const ShellVoxel& voxel : voxels) {
    const Parameters slopes = slopes_and_rest(voxel, ball, q).head<7>();
    const Vec3 p = ball.centre + Vec3(voxel.x, voxel.y, voxel.z);
    for (std::size_t m = 0; m < errors.size(); ++m)
      if (const double error = errors[m](p); error != 0.0)
        sums.col(static_cast<Eigen::Index>(m)) += error * slopes;
  }
  // The blur is not free where grey values are known.
  sums.row(6).setZero();
  const Eigen::Matrix<double, 7, Eigen::Dynamic> shifts = inverse * sums;
  return shifts * shifts.transpose();
}

bool plausible(const Parameters& q, double radius, double contrast) {
  return q.allFinite() && q.head<3>().norm() < 0.7 * radius && q[3] > 0.4 * radius && q[3] < 2.0 * radius &&
         q[6] > 0.1 && q[6] < 0.5 * radius && std::abs(q[4]) < 3.0 * std::abs(contrast);
}

struct Solution {
  Parameters q;
  Equations equations;
  bool converged = false;
};

Solution solved(const std::vector<ShellVoxel>& voxels, const GreyBall& start, const Parameters& from,
                const FitSetting& setting) {
  Solution now{from, equations(voxels, start, from, setting.fit_blur)};
  double damping = 1e-3;
  for (int iteration = 0; iteration < setting.iterations && !now.converged && damping < 1e8; ++iteration) {
    Normal damped = now.equations.matrix;
    damped.diagonal() *= 1.0 + damping;
    const Parameters step = damped.ldlt().solve(now.equations.right);
    const Parameters next = now.q + step;
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

/// Of the sphere's patches, squares on the faces of a cube about it, the one in a direction.
std::size_t patch_of(const Vec3& p) {
  Eigen::Index axis;
  const double most = p.cwiseAbs().maxCoeff(&axis);
  const auto place = [&](double along) {
    const double share = 0.5 + 2.0 / M_PI * std::atan(along / most);
    return std::min(patches_along - 1, static_cast<std::size_t>(share * patches_along));
  };
  const auto face = static_cast<std::size_t>(2 * axis + (p[axis] > 0.0 ? 1 : 0));
  return (face * patches_along + place(p[(axis + 1) % 3])) * patches_along + place(p[(axis + 2) % 3]);
}

/// Drops the voxels of patches in which the mean of what is left, within the ball or around it, is further
/// from zero than means of patches are: something that is not known is there. Whether there were any.
bool drop_foreign(std::vector<ShellVoxel>& voxels, const GreyBall& start, const Parameters& q) {
  constexpr double to_sd = 1.4826;
  std::array<double, 2 * patches> sum{}, count{};
  const auto cell_of = [&](const ShellVoxel& voxel) {
    const Vec3 p(voxel.x - q[0], voxel.y - q[1], voxel.z - q[2]);
    return 2 * patch_of(p) + (p.norm() > q[3] ? 1 : 0);
  };
  for (const ShellVoxel& voxel : voxels) {
    const std::size_t cell = cell_of(voxel);
    sum[cell] += slopes_and_rest(voxel, start, q)[7];
    count[cell] += 1.0;
  }
  std::vector<double> scores;
  for (std::size_t cell = 0; cell < sum.size(); ++cell)
    if (count[cell] > 0.0) scores.push_back(std::abs(sum[cell]) / std::sqrt(count[cell]));
  const double most = kThresholds.foreign_patch * to_sd * median(scores);
  std::array<bool, patches> foreign{};
  for (std::size_t cell = 0; cell < sum.size(); ++cell)
    if (count[cell] > 0.0 && std::abs(sum[cell]) / std::sqrt(count[cell]) > most) foreign[cell / 2] = true;
  return std::erase_if(voxels, [&](const ShellVoxel& voxel) { return foreign[cell_of(voxel) / 2]; }) > 0;
}

}  // namespace

BallFit fit_ball(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                 std::span<const Neighbour> neighbours, const std::optional<Container>& container,
                 const FitSetting& setting, const KnownGrey& known) {
  const GreyBall& start = balls[own];
  const Hidden hidden(balls, own, neighbours, container, setting, known.grey ? 0.0 : setting.half_width);
  Shell shell = with_pixels(
      volume, [&](auto pixels) { return shell_of(pixels, volume, start, hidden, setting, known.grey); });
  BallFit fit{start, setting.blur, 0.0, 0.0, 0.0, shell.free_share, 1.0, false};
  constexpr std::size_t least_samples = 50;
  if (shell.samples.size() < least_samples) return fit;

  Parameters from;
  from << 0.0, 0.0, 0.0, start.radius, start.contrast, start.background, setting.blur;
  Solution solution = solved(shell.samples, start, from, setting);
  const double all = static_cast<double>(shell.samples.size());
  constexpr int most_turns = 3;
  for (int turn = 0; setting.drop_foreign && turn < most_turns; ++turn) {
    if (!drop_foreign(shell.samples, start, solution.q)) break;
    if (shell.samples.size() < least_samples) return fit;
    solution = solved(shell.samples, start, solution.q, setting);
  }
  const auto& [q, now, converged] = solution;
  fit.converged = converged;
  fit.explained_share = static_cast<double>(shell.samples.size()) / all;
  const double n = static_cast<double>(shell.samples.size());
  const double variance = now.squares / (n - 6.0);
  const Normal inverse = now.matrix.ldlt().solve(Normal::Identity());
  const Normal covariance =
      variance * inverse + covariance_of(known.errors, shell.samples, start, q, inverse);
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
