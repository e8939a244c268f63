#include "tracking/match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "packing/generate.h"

namespace pendular {
namespace {

constexpr double kSigma = 0.2e-6;

const Packing& packing() {
  static const Packing made = [] {
    Sample sample;
    sample.specimen.diameter = 2.2e-3, sample.specimen.height = 3.2e-3,
    sample.specimen.volume_fraction = 0.57;
    return generate_packing(sample, 5);
  }();
  return made;
}

Vec3 noise(std::uint64_t stream, std::size_t k) {
  return Vec3(random_normal(stream, 3 * k), random_normal(stream, 3 * k + 1),
              random_normal(stream, 3 * k + 2));
}

Bead measured(Bead bead, std::uint64_t stream, std::size_t k) {
  bead.centre += kSigma * noise(stream, k);
  bead.diameter += kSigma * random_normal(stream + 7, k);
  bead.sigma_centre = bead.sigma_diameter = kSigma;
  return bead;
}

std::vector<Bead> first_scan() {
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < packing().beads.size(); ++k)
    beads.push_back(measured(packing().beads[k], 11, k));
  return beads;
}

struct SecondScan {
  std::vector<Bead> beads;
  std::vector<int> source;  ///< of each, in the first scan; −1: none
};

/// Half of a strain is even, the other half slides along a band five beads wide at 54 degrees to the axis;
/// every bead departs from that by `scatter` (m). One bead in 200 is lost, one in 200 invented, all are
/// shifted, and their order is another.
SecondScan second_scan(double strain, double scatter, const Vec3& shift = Vec3::Zero()) {
  const double height = packing().specimen.height, angle = 54.0 * M_PI / 180.0;
  const Vec3 slide(std::cos(0.5 * M_PI - angle), 0.0, -std::sin(0.5 * M_PI - angle));
  const Vec3 normal(std::sin(0.5 * M_PI - angle), 0.0, std::cos(0.5 * M_PI - angle));
  const double length = 0.5 * strain * height / std::fabs(slide.z());
  const Vec3 middle(0.0, 0.0, packing().specimen.bottom + 0.5 * height);
  SecondScan scan;
  for (std::size_t k = 0; k < packing().beads.size(); ++k) {
    Bead bead = packing().beads[k];
    const Vec3 p = bead.centre - middle;
    bead.centre.z() -= 0.5 * strain * (p.z() + 0.5 * height);
    bead.centre.head<2>() *= 1.0 + 0.2 * strain;
    bead.centre +=
        length * 0.5 * (1.0 + std::tanh(p.dot(normal) / 500e-6)) * slide + scatter * noise(21, k) + shift;
    if (random_uniform(31, k) < 0.005) continue;
    scan.beads.push_back(measured(bead, 12, k));
    scan.source.push_back(static_cast<int>(k));
    if (random_uniform(32, k) < 0.005) {
      bead.centre += 0.7 * bead.diameter * noise(33, k).normalized();
      scan.beads.push_back(measured(bead, 13, k));
      scan.source.push_back(-1);
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

Outcome outcome_of(const SecondScan& scan, const std::vector<BeadMatch>& matches) {
  const double both = static_cast<double>(
      std::count_if(scan.source.begin(), scan.source.end(), [](int k) { return k >= 0; }));
  Outcome outcome;
  for (const auto& match : matches)
    (scan.source[static_cast<std::size_t>(match.after)] == match.before ? outcome.right : outcome.wrong) +=
        1.0 / both;
  return outcome;
}

TEST(Match, FollowsBeadsThroughAShearBand) {
  for (const double strain : {0.02, 0.1}) {
    const SecondScan scan = second_scan(strain, 6e-6);
    const Outcome outcome = outcome_of(scan, match_beads(first_scan(), scan.beads));
    EXPECT_GE(outcome.right, 0.99) << strain;
    EXPECT_LE(outcome.wrong, 0.002) << strain;
  }
}

TEST(Match, FollowsBeadsThatWereShiftedAsAWhole) {
  const SecondScan scan = second_scan(0.05, 6e-6, Vec3(300e-6, -200e-6, 100e-6));
  EXPECT_GE(outcome_of(scan, match_beads(first_scan(), scan.beads)).right, 0.99);
}

TEST(Match, NeedsNoStatedErrors) {
  const SecondScan scan = second_scan(0.05, 6e-6);
  auto before = first_scan(), after = scan.beads;
  for (auto* beads : {&before, &after})
    for (auto& bead : *beads) bead.sigma_centre = bead.sigma_diameter = 0.0;
  EXPECT_GE(outcome_of(scan, match_beads(before, after)).right, 0.97);
}

TEST(Match, AnotherSpecimenIsBadInput) {
  Sample sample;
  sample.specimen.diameter = 2.2e-3, sample.specimen.height = 3.2e-3, sample.specimen.volume_fraction = 0.57;
  EXPECT_THROW(match_beads(first_scan(), generate_packing(sample, 6).beads), BadInput);
  EXPECT_THROW(match_beads({}, first_scan()), BadInput);
}

}  // namespace
}  // namespace pendular
