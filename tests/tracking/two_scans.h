#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"
#include "packing/generate.h"
#include "tracking/match.h"

namespace pendular::test {

inline constexpr double kSigma = 0.2e-6;

inline Packing make_packing(std::uint64_t seed, double diameter = 2.2e-3, double height = 3.2e-3) {
  Sample sample;
  sample.specimen.diameter = diameter, sample.specimen.height = height,
  sample.specimen.volume_fraction = 0.57;
  return generate_packing(sample, seed);
}

inline const Packing& packing() {
  static const Packing made = make_packing(5);
  return made;
}

inline Vec3 noise(std::uint64_t stream, std::size_t k) {
  return Vec3(random_normal(stream, 3 * k), random_normal(stream, 3 * k + 1),
              random_normal(stream, 3 * k + 2));
}

inline Bead measured(Bead bead, std::uint64_t stream, std::size_t k) {
  bead.centre += kSigma * noise(stream, k);
  bead.diameter += kSigma * random_normal(stream + 7, k);
  bead.sigma_centre = bead.sigma_diameter = kSigma;
  return bead;
}

inline std::vector<Bead> first_scan() {
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < packing().beads.size(); ++k)
    beads.push_back(measured(packing().beads[k], 11, k));
  return beads;
}

struct SecondScan {
  std::vector<Bead> beads;
  std::vector<int> source;  ///< of each, in the first scan; −1: none
};

/// How the second scan differs from the first.
struct Change {
  double strain = 0.0;
  double scatter = 0.0;  ///< of the motion of single beads, m
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1.0;
  Vec3 shift = Vec3::Zero();  ///< m
  double loose = 0.0;         ///< share of beads that move by half a diameter besides
};

inline bool is_loose(const Change& change, std::size_t k) {
  return random_uniform(51, k) < change.loose;
}

/// Where beads are once the specimen is compressed: half of the strain is even, the other half slides along a
/// band five beads wide at 54 degrees to the axis.
inline Vec3 deformed(const Vec3& centre, double strain) {
  const double height = packing().specimen.height, angle = 54.0 * M_PI / 180.0;
  const Vec3 slide(std::cos(0.5 * M_PI - angle), 0.0, -std::sin(0.5 * M_PI - angle));
  const Vec3 normal(std::sin(0.5 * M_PI - angle), 0.0, std::cos(0.5 * M_PI - angle));
  const double length = 0.5 * strain * height / std::fabs(slide.z());
  const Vec3 p = centre - Vec3(0.0, 0.0, packing().specimen.bottom + 0.5 * height);
  Vec3 moved = centre;
  moved.z() -= 0.5 * strain * (p.z() + 0.5 * height);
  moved.head<2>() *= 1.0 + 0.2 * strain;
  return moved + length * 0.5 * (1.0 + std::tanh(p.dot(normal) / 500e-6)) * slide;
}

/// Both scans have noise. One bead in 200 is lost, one in 200 invented, and their order is another.
inline SecondScan second_scan(const Change& change) {
  SecondScan scan;
  const auto add = [&](Bead bead, std::uint64_t stream, std::size_t k, int source) {
    bead.centre = change.scale * (change.rotation * bead.centre) + change.shift;
    bead.diameter *= change.scale;
    scan.beads.push_back(measured(bead, stream, k));
    scan.source.push_back(source);
  };
  for (std::size_t k = 0; k < packing().beads.size(); ++k) {
    Bead bead = packing().beads[k];
    bead.centre = deformed(bead.centre, change.strain) + change.scatter * noise(21, k);
    if (is_loose(change, k)) bead.centre += 0.5 * bead.diameter * noise(52, k).normalized();
    if (random_uniform(31, k) < 0.005) continue;
    add(bead, 12, k, static_cast<int>(k));
    if (random_uniform(32, k) < 0.005) {
      bead.centre += 0.7 * bead.diameter * noise(33, k).normalized();
      add(bead, 13, k, -1);
    }
  }
  std::vector<std::size_t> order(scan.beads.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [](std::size_t a, std::size_t b) { return random_uniform(41, a) < random_uniform(41, b); });
  SecondScan shuffled;
  for (const std::size_t k : order)
    shuffled.beads.push_back(scan.beads[k]), shuffled.source.push_back(scan.source[k]);
  return shuffled;
}

/// Shares of the beads that both scans have.
struct Outcome {
  double right = 0.0, wrong = 0.0;
};

inline Outcome outcome_of(const SecondScan& scan, const std::vector<tracking::BeadMatch>& matches) {
  const double both = static_cast<double>(
      std::count_if(scan.source.begin(), scan.source.end(), [](int k) { return k >= 0; }));
  Outcome outcome;
  for (const auto& match : matches)
    (scan.source[static_cast<std::size_t>(match.after)] == match.before ? outcome.right : outcome.wrong) +=
        1.0 / both;
  return outcome;
}

}  // namespace pendular::test
