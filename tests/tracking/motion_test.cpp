#include "tracking/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "two_scans.h"

namespace pendular::tracking {
namespace {

using namespace test;

const Eigen::Matrix3d& rotation() {
  static const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(2.0, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  return turned;
}

TEST(Motion, IsThatOfTheSpecimenInTheFirstFrame) {
  const Change change{.strain = 0.02,
                      .scatter = 3e-6,
                      .rotation = rotation(),
                      .scale = 1.015,
                      .shift = Vec3(9e-3, 4e-3, -7e-3)};
  const SecondScan scan = second_scan(change);
  const auto before = first_scan();
  const Motion motion = follow_beads(before, scan.beads);
  const Outcome outcome = outcome_of(scan, motion.matches);
  EXPECT_GE(outcome.right, 0.99);
  EXPECT_LE(outcome.wrong, 0.002);
  EXPECT_NEAR(motion.strain, 0.02, 0.002);

  std::vector<Vec3> truth;
  Vec3 mean = Vec3::Zero();
  for (const auto& match : motion.matches) {
    const Vec3& centre = packing().beads[static_cast<std::size_t>(match.before)].centre;
    truth.push_back(deformed(centre, change.strain) - centre);
    mean += truth.back() / static_cast<double>(motion.matches.size());
  }
  double off = 0.0, moved = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_EQ(motion.start[k], before[static_cast<std::size_t>(motion.matches[k].before)].centre);
    off += (motion.displacement[k] - (truth[k] - mean)).squaredNorm();
    moved += motion.displacement[k].squaredNorm();
  }
  // Single beads wander by 3 µm along each axis, and the frame is 0.07 degrees off.
  EXPECT_LT(std::sqrt(off / static_cast<double>(truth.size())), 6.5e-6);
  EXPECT_GT(std::sqrt(moved / static_cast<double>(truth.size())), 20e-6);
}

TEST(Motion, IsFoundOfBeadsThatWanderByATenthOfADiameter) {
  const SecondScan scan = second_scan({.strain = 0.1, .scatter = 20e-6, .rotation = rotation()});
  const Outcome outcome = outcome_of(scan, follow_beads(first_scan(), scan.beads).matches);
  EXPECT_GE(outcome.right, 0.99);
  EXPECT_LE(outcome.wrong, 0.002);
}

TEST(Motion, HasTheErrorsOfBothCentres) {
  const auto before = first_scan();
  auto scan = second_scan({.strain = 0.01, .rotation = rotation(), .scale = 0.99});
  for (auto& bead : scan.beads) bead.sigma_centre = 0.3e-6;
  const Motion motion = follow_beads(before, scan.beads);
  for (const double sigma : motion.sigma) EXPECT_NEAR(sigma, std::hypot(0.2e-6, 0.3e-6 / 0.99), 1e-10);
  scan.beads.front().sigma_centre = 0.0;
  const Motion unstated = follow_beads(before, scan.beads);
  EXPECT_EQ(std::count(unstated.sigma.begin(), unstated.sigma.end(), 0.0), scan.source.front() >= 0 ? 1 : 0);
}

TEST(Motion, TellsLooseLostAndNewBeads) {
  const Change change{.strain = 0.02, .scatter = 3e-6, .rotation = rotation(), .loose = 0.01};
  const SecondScan scan = second_scan(change);
  const auto before = first_scan();
  const Motion motion = follow_beads(before, scan.beads);
  double loose = 0.0, found = 0.0, wrong = 0.0;
  for (std::size_t k = 0; k < motion.matches.size(); ++k) {
    const auto& match = motion.matches[k];
    if (scan.source[static_cast<std::size_t>(match.after)] != match.before) continue;
    const bool truly = is_loose(change, static_cast<std::size_t>(match.before));
    loose += truly, found += truly && motion.loose[k], wrong += !truly && motion.loose[k];
  }
  EXPECT_GE(loose, 8.0);
  EXPECT_GE(found, 0.9 * loose);
  EXPECT_LE(wrong, 0.002 * static_cast<double>(motion.matches.size()));

  std::set<int> there(scan.source.begin(), scan.source.end());
  std::size_t truly_lost = 0, lost = 0, truly_new = 0, fresh = 0;
  for (std::size_t k = 0; k < before.size(); ++k) truly_lost += there.count(static_cast<int>(k)) == 0;
  for (const int k : motion.lost) lost += there.count(k) == 0;
  for (const int source : scan.source) truly_new += source < 0;
  for (const int k : motion.fresh) fresh += scan.source[static_cast<std::size_t>(k)] < 0;
  EXPECT_GE(truly_lost, 3u);
  EXPECT_GE(truly_new, 3u);
  EXPECT_GE(lost + 1, truly_lost);
  EXPECT_GE(fresh + 1, truly_new);
  EXPECT_EQ(motion.matches.size() + motion.lost.size(), before.size());
  EXPECT_EQ(motion.matches.size() + motion.fresh.size(), scan.beads.size());
}

TEST(Motion, IsStillWhereNothingMovedBeyondErrors) {
  const auto before = first_scan();
  const Motion same = follow_beads(before, before);
  EXPECT_TRUE(same.still);
  EXPECT_FALSE(same.band.found);
  EXPECT_TRUE(follow_beads(before, second_scan({.rotation = rotation(), .scale = 1.01}).beads).still);
  EXPECT_FALSE(follow_beads(before, second_scan({.strain = 0.001, .rotation = rotation()}).beads).still);
}

}  // namespace
}  // namespace pendular::tracking
