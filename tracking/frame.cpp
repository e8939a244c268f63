#include "tracking/frame.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/quantile.h"
#include "packing/neighbours.h"
#include "tracking/rotation.h"

namespace pendular::tracking {
namespace {

constexpr double kSurroundings = 1.0;  // gap, mean diameters
constexpr int kLeastNeighbours = 8;
constexpr std::size_t kLeastRotations = 20;
constexpr double kRotationWidth = M_PI / 180.0;
constexpr std::size_t kLeastEnd = 10;
constexpr double kEnd = 0.1;                                  // share of the beads that make an end
constexpr double kStrainError = 0.15;                         // of a stated strain, as that of the beads
constexpr double kLateralRatio = 0.3, kLateralRatioSd = 0.2;  // expansion over compression
constexpr double kLeastSpread = 1e-6;                         // of squares across over along

/// Matched beads as columns, in the order of the matches.
struct Columns {
  std::vector<Vec3> before, after;
  std::vector<double> diameters;  ///< in the first scan
};

Columns columns_of(const std::vector<Bead>& before, const std::vector<Bead>& after,
                   const std::vector<BeadMatch>& matches) {
  Columns columns;
  for (const auto& match : matches) {
    const Bead& bead = before[static_cast<std::size_t>(match.before)];
    columns.before.push_back(bead.centre);
    columns.after.push_back(after[static_cast<std::size_t>(match.after)].centre);
    columns.diameters.push_back(bead.diameter);
  }
  return columns;
}

Vec3 mean(const std::vector<Vec3>& places) {
  return std::accumulate(places.begin(), places.end(), Vec3(Vec3::Zero())) /
         static_cast<double>(places.size());
}

/// The linear map that brings `from` onto `to` by least squares; across a flat set of places, the identity.
Eigen::Affine3d linear_motion(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const Vec3 middle = mean(from), middle_to = mean(to);
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero(), square = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    mixed += (to[k] - middle_to) * (from[k] - middle).transpose();
    square += (from[k] - middle) * (from[k] - middle).transpose();
  }
  const double little = 1e-6 * square.trace();
  square += little * Eigen::Matrix3d::Identity();
  mixed += little * Eigen::Matrix3d::Identity();
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.linear() = mixed * square.inverse();
  motion.translation() = middle_to - motion.linear() * middle;
  return motion;
}

/// Beads on a line leave the rotation about it open.
void require_spread(const std::vector<Vec3>& places) {
  const Vec3 middle = mean(places);
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (const auto& place : places) square += (place - middle) * (place - middle).transpose();
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square).eigenvalues();
  if (moments[1] < kLeastSpread * moments[2])
    bad_input("the {} beads that were found again lie on a line, expected them to fill a specimen",
              places.size());
}

Eigen::Matrix3d least_squares_rotation(const Columns& beads) {
  const Vec3 middle = mean(beads.before), middle_after = mean(beads.after);
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < beads.before.size(); ++k)
    mixed += (beads.after[k] - middle_after) * (beads.before[k] - middle).transpose();
  return nearest_rotation(mixed);
}

/// How the surroundings of each bead are turned beyond `rotation`, as vectors along the axis as long as the
/// angle; of beads whose neighbours determine it.
std::vector<Vec3> local_rotations(const Columns& beads, const Eigen::Matrix3d& rotation) {
  struct Moments {
    Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero(), square = Eigen::Matrix3d::Zero();
    int neighbours = 0;
  };
  const double diameter = std::accumulate(beads.diameters.begin(), beads.diameters.end(), 0.0) /
                          static_cast<double>(beads.diameters.size());
  std::vector<Moments> moments(beads.before.size());
  for (const auto& [i, j] : pairs_within(beads.before, beads.diameters, kSurroundings * diameter)) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const Vec3 from = beads.before[b] - beads.before[a];
    const Vec3 to = rotation.transpose() * (beads.after[b] - beads.after[a]);
    for (const auto k : {a, b}) {
      moments[k].mixed += to * from.transpose();
      moments[k].square += from * from.transpose();
      ++moments[k].neighbours;
    }
  }
  std::vector<Vec3> rotations;
  for (const auto& moment : moments) {
    const double size = moment.square.trace() / 3.0;
    if (moment.neighbours < kLeastNeighbours || moment.square.determinant() < 1e-3 * size * size * size)
      continue;
    const Eigen::AngleAxisd turned(nearest_rotation(moment.mixed * moment.square.inverse()));
    rotations.push_back(turned.angle() * turned.axis());
  }
  return rotations;
}

/// Where vectors lie most densely: mean shift (Fukunaga & Hostetler 1975, IEEE Trans. Inf. Theory 21, 32)
/// from their median.
Vec3 densest(const std::vector<Vec3>& vectors, double width) {
  Vec3 at;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& vector : vectors) values.push_back(vector[axis]);
    at[axis] = median(std::move(values));
  }
  for (int round = 0; round < 200; ++round) {
    double weights = 0.0;
    Vec3 sum = Vec3::Zero();
    for (const auto& vector : vectors) {
      const double weight = std::exp(-0.5 * (vector - at).squaredNorm() / (width * width));
      weights += weight, sum += weight * vector;
    }
    if (weights == 0.0) return at;
    Vec3 next = sum / weights;
    if ((next - at).norm() < 1e-9) return next;
    at = next;
  }
  return at;
}

/// The outer beads at the specimen's lower and upper end, by their places in the columns: a tenth of all, at
/// least three.
std::array<std::vector<std::size_t>, 2> ends_of(const std::vector<Vec3>& places) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(places[a].z(), a) < std::pair(places[b].z(), b);
  });
  const auto count = static_cast<std::ptrdiff_t>(
      std::max(std::min<std::size_t>(3, places.size()),
               static_cast<std::size_t>(kEnd * static_cast<double>(places.size()))));
  return {std::vector(order.begin(), order.begin() + count), std::vector(order.end() - count, order.end())};
}

/// The rotation vector, across z, by which the planes of both ends are turned on average: from the slopes of
/// u_z over x and y there. Nothing where ends are too few beads for a plane.
std::optional<Vec3> tilt_of_ends(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 tilt = Vec3::Zero();
  for (const auto& end : ends_of(from)) {
    if (end.size() < kLeastEnd) return std::nullopt;
    Vec3 middle = Vec3::Zero();
    for (const auto k : end) middle += from[k] / static_cast<double>(end.size());
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const auto k : end) {
      const Vec3 p = from[k] - middle;
      const Eigen::Vector4d row(1.0, p.x() / 1e-3, p.y() / 1e-3, p.z() / 1e-3);
      matrix += row * row.transpose(), right += row * (to[k].z() - from[k].z()) / 1e-3;
    }
    const Eigen::Vector4d slopes = matrix.ldlt().solve(right);
    tilt += 0.5 * Vec3(slopes[2], -slopes[1], 0.0);
  }
  return tilt;
}

Eigen::Matrix3d turned_by(const Vec3& rotation) {
  return rotation.norm() > 0.0 ? Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix()
                               : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

Eigen::Matrix3d frame_rotation(const Columns& beads) {
  Eigen::Matrix3d rotation = least_squares_rotation(beads);
  const auto local = local_rotations(beads, rotation);
  if (local.size() < kLeastRotations) return rotation;
  rotation *= turned_by(densest(local, kRotationWidth));
  for (int round = 0; round < 3; ++round) {
    std::vector<Vec3> upright;
    for (const auto& centre : beads.after) upright.push_back(rotation.transpose() * centre);
    const auto tilt = tilt_of_ends(beads.before, upright);
    if (!tilt) return rotation;
    rotation *= turned_by(*tilt);
  }
  return rotation;
}

/// A number with its standard error.
struct Estimate {
  double value = 1.0, sigma = 0.0;
};

/// Ratio of the distances between the specimen's ends, along z of the first scan.
Estimate end_stretch(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double length = 0.0, growth = 0.0, variance = 0.0, sign = -1.0;
  for (const auto& end : ends_of(from)) {
    const auto count = static_cast<double>(end.size());
    double height = 0.0, moved = 0.0, square = 0.0;
    for (const auto k : end) height += from[k].z() / count, moved += (to[k].z() - from[k].z()) / count;
    for (const auto k : end) square += std::pow(to[k].z() - from[k].z() - moved, 2) / count;
    length += sign * height, growth += sign * moved, variance += square / count;
    sign = 1.0;
  }
  if (length <= 0.0) return {1.0, 1.0};
  return {1.0 + growth / length, std::sqrt(variance) / length};
}

/// Whether diameters scatter at least half as much as their stated errors: others were not measured.
bool are_measured(const std::vector<Bead>& beads) {
  double mean_of = 0.0, variance = 0.0, stated = 0.0;
  for (const auto& bead : beads) mean_of += bead.diameter / static_cast<double>(beads.size());
  for (const auto& bead : beads) {
    variance += (bead.diameter - mean_of) * (bead.diameter - mean_of);
    stated += bead.sigma_diameter * bead.sigma_diameter;
  }
  return variance > 0.25 * stated;
}

std::optional<Estimate> scale_by_diameters(const std::vector<Bead>& before, const std::vector<Bead>& after,
                                           const std::vector<BeadMatch>& matches) {
  if (!are_measured(before) || !are_measured(after)) return std::nullopt;
  const auto sums_with = [&](auto&& add) {
    for (const auto& match : matches) {
      const Bead &a = before[static_cast<std::size_t>(match.before)],
                 &b = after[static_cast<std::size_t>(match.after)];
      if (a.sigma_diameter > 0.0 && b.sigma_diameter > 0.0)
        add(a, b, 1.0 / (a.sigma_diameter * a.sigma_diameter + b.sigma_diameter * b.sigma_diameter));
    }
  };
  double sum_before = 0.0, sum_after = 0.0;
  sums_with([&](const Bead& a, const Bead& b, double weight) {
    sum_before += weight * a.diameter, sum_after += weight * b.diameter;
  });
  if (sum_before == 0.0) return std::nullopt;
  const double scale = sum_after / sum_before;
  double stated = 0.0, scatter = 0.0;
  sums_with([&](const Bead& a, const Bead& b, double weight) {
    const double off = b.diameter - scale * a.diameter;
    stated += weight * weight *
              (b.sigma_diameter * b.sigma_diameter + scale * scale * a.sigma_diameter * a.sigma_diameter);
    scatter += weight * weight * off * off;
  });
  return Estimate{scale, std::sqrt(std::max(stated, scatter)) / sum_before};
}

/// `upright`: centres of the second scan, turned as those of the first.
void set_scale(Registration& registration, const Columns& beads, const std::vector<Vec3>& upright,
               std::optional<Estimate> by_diameters, std::optional<double> strain) {
  const Estimate axial = end_stretch(beads.before, upright);
  const Eigen::Affine3d linear = linear_motion(beads.before, upright);
  const double ratio = 0.5 * (linear.linear()(0, 0) + linear.linear()(1, 1)) / axial.value;
  const double guess = (ratio - 1.0) / (kLateralRatio + ratio);
  const auto take = [&](const Estimate& scale, ScaleSource source) {
    registration.motion.scale = scale.value;
    registration.scale_sigma = scale.sigma;
    registration.scale_from = source;
  };
  take({axial.value / (1.0 - guess),
        std::hypot(std::fabs(guess) * kLateralRatioSd / (1.0 + kLateralRatio), axial.sigma)},
       ScaleSource::lateral);
  if (strain) {
    const Estimate scale{axial.value / (1.0 - *strain),
                         std::hypot(kStrainError * std::fabs(*strain), axial.sigma)};
    if (scale.sigma < registration.scale_sigma) take(scale, ScaleSource::strain);
  }
  if (by_diameters && by_diameters->sigma < registration.scale_sigma)
    take(*by_diameters, ScaleSource::diameters);
  registration.axial_stretch = axial.value / registration.motion.scale;
}

}  // namespace

std::string to_string(ScaleSource source) {
  switch (source) {
    case ScaleSource::diameters:
      return "diameters";
    case ScaleSource::strain:
      return "strain";
    case ScaleSource::lateral:
      return "lateral";
  }
  return "";
}

std::vector<Bead> registered(const std::vector<Bead>& after, const Similarity& motion) {
  std::vector<Bead> beads = after;
  for (auto& bead : beads) {
    bead.centre = motion.rotation.transpose() * (bead.centre - motion.shift) / motion.scale;
    bead.diameter /= motion.scale;
    bead.sigma_centre /= motion.scale, bead.sigma_diameter /= motion.scale;
  }
  return beads;
}

Registration registration_of(const std::vector<Bead>& before, const std::vector<Bead>& after,
                             const std::vector<BeadMatch>& matches, std::optional<double> strain) {
  if (matches.size() < 4) bad_input("{} beads were found again, expected at least four", matches.size());
  const Columns beads = columns_of(before, after, matches);
  require_spread(beads.before);
  Registration registration;
  registration.beads = matches.size();
  Similarity& motion = registration.motion;
  motion.rotation = frame_rotation(beads);
  std::vector<Vec3> upright;
  for (const auto& centre : beads.after) upright.push_back(motion.rotation.transpose() * centre);
  set_scale(registration, beads, upright, scale_by_diameters(before, after, matches), strain);
  motion.shift = motion.rotation * (mean(upright) - motion.scale * mean(beads.before));

  std::vector<Vec3> now;
  for (const auto& centre : beads.after)
    now.push_back(motion.rotation.transpose() * (centre - motion.shift) / motion.scale);
  registration.even = linear_motion(beads.before, now);
  double square = 0.0, square_even = 0.0;
  for (std::size_t k = 0; k < now.size(); ++k) {
    square += (now[k] - beads.before[k]).squaredNorm();
    square_even += (now[k] - registration.even * beads.before[k]).squaredNorm();
  }
  registration.rms_residual = std::sqrt(square / static_cast<double>(now.size()));
  registration.rms_residual_even = std::sqrt(square_even / static_cast<double>(now.size()));
  return registration;
}

}  // namespace pendular::tracking
