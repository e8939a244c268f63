#include "packing/soft_spheres.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/random.h"
#include "packing/neighbours.h"

namespace pendular {
namespace {

constexpr double kSkin = 0.15;         // neighbours are listed up to this gap
constexpr double kLongestStep = 0.35;  // stable for a sphere with a dozen overlaps of unit stiffness
constexpr std::size_t kBlock = 512;

/// Sum of term(k) over [0, size), the same for any number of threads.
template <typename Value, typename Term, typename Join>
Value reduce(std::size_t size, Value zero, const Term& term, const Join& join) {
  std::vector<Value> parts((size + kBlock - 1) / kBlock, zero);
  for_blocks(size, kBlock, [&](std::size_t first, std::size_t last) {
    Value& part = parts[first / kBlock];
    for (std::size_t k = first; k < last; ++k) part = join(part, term(k));
  });
  Value all = zero;
  for (const Value& part : parts) all = join(all, part);
  return all;
}

double largest(double a, double b) {
  return std::max(a, b);
}

}  // namespace

SoftSpheres::SoftSpheres(const Cylinder& cylinder, std::vector<Vec3> centres, std::vector<double> diameters)
    : cylinder_(cylinder),
      centres_(std::move(centres)),
      velocities_(centres_.size(), Vec3::Zero()),
      forces_(centres_.size(), Vec3::Zero()),
      diameters_(std::move(diameters)) {}

void SoftSpheres::update_neighbours() {
  if (listed_at_.size() == centres_.size()) {
    const double moved = reduce(
        centres_.size(), 0.0, [&](std::size_t k) { return (centres_[k] - listed_at_[k]).squaredNorm(); },
        largest);
    if (moved < 0.25 * kSkin * kSkin) return;
  }
  const auto pairs = pairs_within(centres_, diameters_, kSkin);
  first_neighbour_.assign(centres_.size() + 1, 0);
  for (const auto& [i, j] : pairs) {
    ++first_neighbour_[static_cast<std::size_t>(i) + 1];
    ++first_neighbour_[static_cast<std::size_t>(j) + 1];
  }
  for (std::size_t k = 1; k < first_neighbour_.size(); ++k) first_neighbour_[k] += first_neighbour_[k - 1];
  std::vector<std::size_t> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
  neighbours_.resize(2 * pairs.size());
  for (const auto& [i, j] : pairs) {
    neighbours_[next[static_cast<std::size_t>(i)]++] = j;
    neighbours_[next[static_cast<std::size_t>(j)]++] = i;
  }
  listed_at_ = centres_;
}

double SoftSpheres::update_forces() {
  update_neighbours();
  return reduce(
      centres_.size(), 0.0,
      [&](std::size_t i) {
        const Vec3& at = centres_[i];
        const double radius = 0.5 * diameters_[i];
        Vec3 force = Vec3::Zero();
        double deepest = 0.0;
        const auto push = [&](double overlap, const Vec3& direction) {
          force += overlap * direction;
          deepest = std::max(deepest, overlap);
        };
        for (std::size_t n = first_neighbour_[i]; n < first_neighbour_[i + 1]; ++n) {
          const auto j = static_cast<std::size_t>(neighbours_[n]);
          const Vec3 apart = at - centres_[j];
          const double reach = radius + 0.5 * diameters_[j];
          const double squared = apart.squaredNorm();
          if (squared >= reach * reach || squared == 0.0) continue;
          const double distance = std::sqrt(squared);
          push(reach - distance, apart / distance);
        }
        const double off_axis = std::hypot(at.x(), at.y());
        if (off_axis + radius > cylinder_.radius)
          push(off_axis + radius - cylinder_.radius, Vec3(-at.x() / off_axis, -at.y() / off_axis, 0.0));
        if (at.z() < radius) push(radius - at.z(), Vec3::UnitZ());
        if (at.z() + radius > cylinder_.height) push(at.z() + radius - cylinder_.height, -Vec3::UnitZ());
        forces_[i] = force;
        return deepest;
      },
      largest);
}

void SoftSpheres::move(double time_step) {
  for_blocks(centres_.size(), kBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      velocities_[k] += time_step * forces_[k];
      centres_[k] += time_step * velocities_[k];
    }
  });
}

double SoftSpheres::quench(int steps, double tolerance) {
  // Constants of Bitzek et al. 2006.
  constexpr double kMixing = 0.1, kMixingDecay = 0.99, kGrow = 1.1, kShrink = 0.5;
  constexpr int kPatience = 5;
  double mixing = kMixing, time_step = 0.3 * kLongestStep;
  int downhill = 0;
  std::fill(velocities_.begin(), velocities_.end(), Vec3::Zero());
  double overlap = update_forces();
  for (int step = 0; step < steps && overlap >= tolerance; ++step) {
    if (step % 100 == 0) stop_if_interrupted();
    const Vec3 sums = reduce(
        centres_.size(), Vec3(Vec3::Zero()),
        [&](std::size_t k) {
          return Vec3(forces_[k].dot(velocities_[k]), forces_[k].squaredNorm(), velocities_[k].squaredNorm());
        },
        [](const Vec3& a, const Vec3& b) { return Vec3(a + b); });
    if (sums[0] > 0.0 || step == 0) {
      const double turn = sums[1] > 0.0 ? mixing * std::sqrt(sums[2] / sums[1]) : 0.0;
      for (std::size_t k = 0; k < centres_.size(); ++k)
        velocities_[k] = (1.0 - mixing) * velocities_[k] + turn * forces_[k];
      if (++downhill > kPatience) {
        time_step = std::min(time_step * kGrow, kLongestStep);
        mixing *= kMixingDecay;
      }
    } else {
      std::fill(velocities_.begin(), velocities_.end(), Vec3::Zero());
      time_step *= kShrink;
      mixing = kMixing;
      downhill = 0;
    }
    move(time_step);
    overlap = update_forces();
  }
  return overlap;
}

void SoftSpheres::shake(int steps, double speed, std::uint64_t seed) {
  for (std::size_t k = 0; k < centres_.size(); ++k)
    for (int axis = 0; axis < 3; ++axis)
      velocities_[k][axis] = speed * random_normal(seed, 3 * k + static_cast<std::size_t>(axis));
  for (int step = 0; step < steps; ++step) {
    if (step % 100 == 0) stop_if_interrupted();
    update_forces();
    move(0.5 * kLongestStep);
  }
}

}  // namespace pendular
