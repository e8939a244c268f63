#include "tracking/match.h"

#include <gtest/gtest.h>

#include "tracking/registration.h"
#include "two_scans.h"

namespace pendular::tracking {
namespace {

using namespace test;

std::vector<BeadMatch> matches_of(const std::vector<Bead>& before, const std::vector<Bead>& after) {
  const Registration registration = register_scans(before, after);
  return match_beads(before, registered(after, registration.motion), registration.even);
}

TEST(Match, FollowsBeadsThroughAShearBand) {
  for (const double strain : {0.02, 0.1}) {
    const SecondScan scan = second_scan({.strain = strain, .scatter = 6e-6});
    const Outcome outcome = outcome_of(scan, matches_of(first_scan(), scan.beads));
    EXPECT_GE(outcome.right, 0.99) << strain;
    EXPECT_LE(outcome.wrong, 0.002) << strain;
  }
}

TEST(Match, NeedsNoStatedErrors) {
  const SecondScan scan = second_scan({.strain = 0.05, .scatter = 6e-6});
  auto before = first_scan(), after = scan.beads;
  for (auto* beads : {&before, &after})
    for (auto& bead : *beads) bead.sigma_centre = bead.sigma_diameter = 0.0;
  EXPECT_GE(outcome_of(scan, matches_of(before, after)).right, 0.97);
}

TEST(Match, ReachIsMeasuredFromTheEvenMotion) {
  const auto before = first_scan();
  const SecondScan scan = second_scan({.shift = Vec3(0.0, 0.0, 1e-3)});
  Eigen::Affine3d even = Eigen::Affine3d::Identity();
  EXPECT_LT(outcome_of(scan, match_beads(before, scan.beads, even)).right, 0.01);
  even.translation() = Vec3(0.0, 0.0, 1e-3);
  EXPECT_GE(outcome_of(scan, match_beads(before, scan.beads, even)).right, 0.99);
}

}  // namespace
}  // namespace pendular::tracking
