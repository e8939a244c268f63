#include "tracking/registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "two_scans.h"

namespace pendular::tracking {
namespace {

using namespace test;

constexpr double kDegree = M_PI / 180.0;

Eigen::Matrix3d turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * kDegree, axis.normalized()).toRotationMatrix();
}

/// Evenly distributed over all rotations (Shoemake 1992).
Eigen::Matrix3d any_turn(std::uint64_t seed) {
  return Eigen::Quaterniond(random_normal(seed, 0), random_normal(seed, 1), random_normal(seed, 2),
                            random_normal(seed, 3))
      .normalized()
      .toRotationMatrix();
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.transpose() * b)).angle() / kDegree;
}

/// What a registration gets wrong. The test's band is so wide that it bends the ends: by 0.07 degrees at 2 %
/// of strain, in proportion to it.
void expect_found(const Change& change, const Registration& registration, std::size_t beads) {
  EXPECT_GE(static_cast<double>(registration.beads), 0.98 * static_cast<double>(beads));
  EXPECT_LE(angle_between(registration.motion.rotation, change.rotation), 0.02 + 4.0 * change.strain);
  EXPECT_NEAR(registration.motion.rotation.determinant(), 1.0, 1e-12);
  EXPECT_LE(std::fabs(registration.motion.scale - change.scale), 4.0 * registration.scale_sigma);
}

/// What the one line of a refusal says; empty where nothing is refused.
std::string refusal(const std::vector<Bead>& before, const std::vector<Bead>& after) {
  try {
    register_scans(before, after);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Registration, FindsAnyRotationAndShift) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
    for (const double degrees : {0.0, 90.0, 180.0}) rotations.push_back(turn(degrees, axis));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) rotations.push_back(any_turn(seed));
  const auto before = first_scan();
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    SCOPED_TRACE(k);
    const Change change{.strain = 0.02,
                        .scatter = 3e-6,
                        .rotation = rotations[k],
                        .scale = 0.98 + 0.01 * static_cast<double>(k % 5),
                        .shift = 10e-3 * noise(61, k)};
    const Registration registration = register_scans(before, second_scan(change).beads);
    expect_found(change, registration, before.size());
    EXPECT_EQ(registration.scale_from, ScaleSource::diameters);
    EXPECT_LT(registration.scale_sigma, 5e-5);
  }
}

TEST(Registration, BearsStrainUpToEightPerCent) {
  const auto before = first_scan();
  for (const double strain : {0.0, 0.005, 0.02, 0.05, 0.08}) {
    SCOPED_TRACE(strain);
    const Change change{.strain = strain,
                        .scatter = 6e-6,
                        .rotation = any_turn(7),
                        .scale = 1.02,
                        .shift = Vec3(5e-3, -8e-3, 3e-3)};
    const Registration registration = register_scans(before, second_scan(change).beads);
    expect_found(change, registration, before.size());
    EXPECT_NEAR(registration.axial_stretch, 1.0 - strain, 6e-4 + 0.1 * strain);
  }
}

TEST(Registration, WithoutDiametersStrainTellsTheScale) {
  auto before = first_scan();
  for (const double strain : {0.01, 0.05}) {
    SCOPED_TRACE(strain);
    const Change change{.strain = strain, .scatter = 6e-6, .rotation = any_turn(8), .scale = 0.985};
    auto after = second_scan(change).beads;
    for (auto* beads : {&before, &after})
      for (auto& bead : *beads) bead.sigma_diameter = 0.0;
    const Registration by_strain = register_scans(before, after, strain);
    expect_found(change, by_strain, before.size());
    EXPECT_EQ(by_strain.scale_from, ScaleSource::strain);
    EXPECT_LT(by_strain.scale_sigma, 0.16 * strain);
    const Registration by_shape = register_scans(before, after);
    expect_found(change, by_shape, before.size());
    EXPECT_EQ(by_shape.scale_from, ScaleSource::lateral);
    EXPECT_GT(by_shape.scale_sigma, by_strain.scale_sigma);
    EXPECT_LT(by_shape.scale_sigma, 0.2 * strain + 1e-3);
  }
}

TEST(Registration, NominalDiametersDoNotTellTheScale) {
  auto before = first_scan();
  auto after = second_scan({.strain = 0.02, .scatter = 3e-6, .rotation = any_turn(13), .scale = 0.99}).beads;
  for (auto* beads : {&before, &after})
    for (auto& bead : *beads) bead.diameter = 200e-6;
  const Registration registration = register_scans(before, after);
  EXPECT_EQ(registration.scale_from, ScaleSource::lateral);
  EXPECT_LE(std::fabs(registration.motion.scale - 0.99), 4.0 * registration.scale_sigma);
}

TEST(Registration, OfBeadsOnALineIsRefused) {
  std::vector<Bead> before;
  for (std::size_t k = 0; k < 20; ++k) {
    Bead bead;
    bead.id = static_cast<std::int64_t>(k), bead.diameter = 200e-6;
    bead.centre =
        Vec3(210e-6 * static_cast<double>(k) + 8e-6 * random_normal(81, k), 0.0, 0.0) + 0.2e-6 * noise(82, k);
    before.push_back(bead);
  }
  EXPECT_FALSE(refusal(before, before).empty());
}

TEST(Registration, FindsAPartOfTheSpecimen) {
  const auto before = first_scan();
  const Change change{.strain = 0.03, .scatter = 3e-6, .rotation = any_turn(9), .scale = 1.01};
  std::vector<Bead> part;
  const SecondScan scan = second_scan(change);
  for (std::size_t k = 0; k < scan.beads.size(); ++k)
    if (scan.source[k] >= 0 && before[static_cast<std::size_t>(scan.source[k])].centre.z() < 1.6e-3)
      part.push_back(scan.beads[k]);
  const Registration registration = register_scans(before, part);
  EXPECT_GE(static_cast<double>(registration.beads), 0.98 * static_cast<double>(part.size()));
  EXPECT_LE(angle_between(registration.motion.rotation, change.rotation), 1.0);
  EXPECT_LE(std::fabs(registration.motion.scale - change.scale), 4.0 * registration.scale_sigma);
}

TEST(Registration, RegisteredBeadsLieInTheFirstFrame) {
  const auto before = first_scan();
  const Similarity motion{any_turn(10), 1.015, Vec3(1e-3, 2e-3, -3e-3)};
  auto after = before;
  for (auto& bead : after) {
    bead.centre = motion.scale * (motion.rotation * bead.centre) + motion.shift;
    bead.diameter *= motion.scale;
  }
  const auto back = registered(after, motion);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_LT((back[k].centre - before[k].centre).norm(), 1e-15);
    EXPECT_NEAR(back[k].diameter, before[k].diameter, 1e-15);
  }
}

TEST(Registration, RefusesAMirrorImage) {
  const auto before = first_scan();
  for (const Vec3& flip : {Vec3(-1.0, 1.0, 1.0), Vec3(1.0, 1.0, -1.0), Vec3(-1.0, -1.0, -1.0)}) {
    auto after = second_scan({.strain = 0.03, .scatter = 3e-6, .rotation = any_turn(11)}).beads;
    for (auto& bead : after) bead.centre = flip.cwiseProduct(bead.centre);
    const std::string line = refusal(before, after);
    EXPECT_NE(line.find("matches mirrored"), std::string::npos) << line;
  }
}

TEST(Registration, RefusesAnotherSpecimen) {
  const auto before = first_scan();
  for (const bool stated : {true, false}) {
    auto other = make_packing(6).beads;
    for (auto& bead : other) bead.sigma_diameter = stated ? kSigma : 0.0;
    const std::string line = refusal(before, other);
    EXPECT_NE(line.find("same specimen"), std::string::npos) << line;
  }
  EXPECT_FALSE(refusal({}, before).empty());
}

/// The beads nearest to the specimen's middle.
std::vector<Bead> some_of(std::vector<Bead> beads, std::size_t count) {
  const Vec3 middle(0.0, 0.0, 1.6e-3);
  std::sort(beads.begin(), beads.end(), [&](const Bead& a, const Bead& b) {
    return (a.centre - middle).norm() < (b.centre - middle).norm();
  });
  beads.resize(count);
  return beads;
}

TEST(Registration, OfTenBeadsIsFoundAndOfTenOthersRefused) {
  for (const std::size_t count : {10u, 30u, 100u}) {
    SCOPED_TRACE(count);
    const auto before = some_of(first_scan(), count);
    auto after = before;
    const Eigen::Matrix3d rotation = any_turn(12);
    for (std::size_t k = 0; k < count; ++k) {
      after[k].centre = rotation * after[k].centre + 1e-6 * noise(71, k);
      after[k].sigma_diameter = 0.0;
    }
    EXPECT_LE(angle_between(register_scans(before, after).motion.rotation, rotation), 1.0);
    for (std::uint64_t seed = 6; seed < 9; ++seed) {
      auto other = some_of(make_packing(seed).beads, count);
      for (auto& bead : other) bead.sigma_diameter = 0.0;
      EXPECT_FALSE(refusal(before, other).empty()) << seed;
    }
  }
}

}  // namespace
}  // namespace pendular::tracking
