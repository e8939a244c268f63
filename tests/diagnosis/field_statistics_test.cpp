#include "diagnosis/kinds/field_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "followed.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSigma = 0.1;  // µm, of a component

FollowedBeads followed(double share_lost = 0.0) {
  FollowedBeads all;
  for (const auto& bead : test::followed_specimen())
    if (random_uniform(31, static_cast<std::uint64_t>(bead.id)) >= share_lost) all.beads.push_back(bead);
  all.cutoff = 20e-6;
  all.sigma_um = kSigma;
  all.strain = 0.02;
  return all;
}

/// A field in µm of the beads that were followed.
template <typename Motion>
Eigen::VectorXd field(const FollowedBeads& of, const Motion& motion) {
  Eigen::VectorXd values(3 * static_cast<Eigen::Index>(of.beads.size()));
  for (std::size_t k = 0; k < of.beads.size(); ++k)
    values.segment<3>(3 * static_cast<Eigen::Index>(k)) = motion(of.beads[k]);
  return values;
}

/// What is believed: a compression along z.
Eigen::VectorXd reference(const FollowedBeads& of) {
  return field(of, [](const Bead& bead) -> Vec3 { return 1e6 * test::compressed(bead.centre, 0.02); });
}

/// An effect that does the same in every run: the specimen bends, 3 µm at θ = 1.
Eigen::VectorXd bending(const FollowedBeads& of, double theta) {
  return field(of, [&](const Bead& bead) -> Vec3 {
    return {3.0 * theta * std::sin(3e3 * bead.centre.z()), 0, 0};
  });
}

/// An effect that leaves to chance which beads move: one in five, by 5 µm at θ = 1.
Eigen::VectorXd drawn(const FollowedBeads& of, double theta, std::uint64_t draw) {
  return field(of, [&](const Bead& bead) -> Vec3 {
    const auto id = static_cast<std::uint64_t>(bead.id);
    if (random_uniform(draw, id) > 0.2) return Vec3::Zero();
    return 5.0 * theta *
           Vec3(random_normal(draw, 1000 + 3 * id), random_normal(draw, 1001 + 3 * id),
                random_normal(draw, 1002 + 3 * id)) /
           std::sqrt(3.0);
  });
}

std::vector<BankField> bank(const FollowedBeads& of) {
  std::vector<BankField> all;
  for (int member = 1; member <= 6; ++member) {
    const auto own = static_cast<std::uint64_t>(100 + member);
    all.push_back({member, "", 0.0, reference(of) + drawn(of, 0.02, own)});
  }
  for (int level = 1; level <= 3; ++level)
    for (int draw = 0; draw < 3; ++draw) {
      const double theta = level / 3.0;
      const int member = 1 + (3 * level + draw) % 6;
      const Eigen::VectorXd baseline = all[static_cast<std::size_t>(member) - 1].values;
      all.push_back({member, "bending", theta, baseline + bending(of, theta)});
      all.push_back({member, "drawn", theta,
                     baseline + drawn(of, theta, static_cast<std::uint64_t>(10 * level + draw))});
    }
  return all;
}

double named(const FieldStatistics& statistics, const Eigen::VectorXd& values, const std::string& name) {
  const auto at =
      std::find(statistics.names().begin(), statistics.names().end(), name) - statistics.names().begin();
  return values[at];
}

TEST(FieldStatistics, WhatEveryRunShowsIsAModeAndWhatIsDrawnIsNone) {
  const auto beads = followed();
  const FieldStatistics read(beads, bank(beads));
  ASSERT_EQ(read.modes().cols(), 1);
  const Eigen::VectorXd planted = bending(beads, 1.0);
  EXPECT_GT(std::fabs(read.modes().col(0).dot(planted.normalized())), 0.99);
  // Its score is the planted motion's size per bead, and as much less at half the magnitude.
  const double whole = named(read, read(read.reference() + planted), "mode_1"),
               half = named(read, read(read.reference() + 0.5 * planted), "mode_1");
  EXPECT_NEAR(std::fabs(whole), planted.norm() / std::sqrt(static_cast<double>(beads.beads.size())),
              0.02 * std::fabs(whole));
  EXPECT_NEAR(half, 0.5 * whole, 1e-9);
}

TEST(FieldStatistics, RepeatFromDrawToDraw) {
  // The fields of two draws have little in common; their readings do.
  const auto beads = followed();
  const FieldStatistics read(beads, bank(beads));
  const Eigen::VectorXd none = read(read.reference() + read.noise(1));
  double apart = 0.0, alike = 0.0;
  for (std::uint64_t draw = 500; draw < 510; ++draw) {
    const Eigen::VectorXd one = drawn(beads, 0.6, draw), other = drawn(beads, 0.6, draw + 100);
    EXPECT_LT(std::fabs(one.normalized().dot(other.normalized())), 0.25);
    const Eigen::VectorXd of_one = read(read.reference() + one + read.noise(draw)),
                          of_other = read(read.reference() + other + read.noise(draw + 100));
    for (const char* name : {"left_size", "pairs_parting", "pairs_sliding", "left_middle"}) {
      apart += std::fabs(named(read, of_one, name) - named(read, none, name));
      alike += std::fabs(named(read, of_one, name) - named(read, of_other, name));
    }
  }
  EXPECT_GT(apart, 8.0 * alike);
}

TEST(FieldStatistics, NoiseHasTheStatedSizeAndIsTakenOff) {
  const auto beads = followed();
  const FieldStatistics read(beads, bank(beads));
  const Eigen::VectorXd noise = read.noise(7);
  EXPECT_NEAR(std::sqrt(noise.squaredNorm() / static_cast<double>(noise.size())), kSigma, 0.1 * kSigma);
  EXPECT_NE(read.noise(8), noise);
  // A wave of ten noises beside the noise: the logarithm of its own size.
  const Eigen::VectorXd wave = field(beads, [](const Bead& bead) -> Vec3 {
    return {0, std::sqrt(2.0) * std::sin(2e4 * bead.centre.x()), 0};
  });
  const double size = std::log(wave.norm() / std::sqrt(static_cast<double>(beads.beads.size())));
  EXPECT_NEAR(named(read, read(read.reference() + wave + noise), "field_size"), size, 0.02);
  // Noise alone is no motion: at least half of its size is taken off.
  EXPECT_LT(named(read, read(read.reference() + noise), "field_size"),
            std::log(std::sqrt(3.0) * kSigma) - std::log(1.8));
}

TEST(FieldStatistics, LostBeadsAreNoLoss) {
  const auto all = followed(), some = followed(0.08);
  ASSERT_LT(some.beads.size(), all.beads.size() - 10);
  const FieldStatistics of_all(all, bank(all)), of_some(some, bank(some));
  ASSERT_EQ(of_all.names(), of_some.names());
  const Eigen::VectorXd whole = of_all(reference(all) + bending(all, 0.7) + drawn(all, 0.5, 900)),
                        part = of_some(reference(some) + bending(some, 0.7) + drawn(some, 0.5, 900));
  for (const char* name : {"field_size", "left_size", "pairs_parting", "pairs_sliding", "left_rim"})
    EXPECT_NEAR(named(of_some, part, name), named(of_all, whole, name), 0.12) << name;
  EXPECT_NEAR(std::fabs(named(of_some, part, "mode_1")), std::fabs(named(of_all, whole, "mode_1")), 0.1);
}

TEST(FieldStatistics, TellsWherePairsPart) {
  // Steep pairs, which the compression closes, part by 1 µm: as if the bridges did not yield.
  const auto beads = followed();
  const FieldStatistics read(beads, bank(beads));
  const Eigen::VectorXd stretched = read.reference() + field(beads, [](const Bead& bead) -> Vec3 {
                                      return {0, 0, 0.005 * 1e6 * bead.centre.z()};
                                    });
  const auto change = [&](const char* name) {
    return named(read, read(stretched), name) - named(read, read(read.reference()), name);
  };
  EXPECT_NEAR(change("steep_parting"), 0.005 * 200.0 * 0.5, 0.2);  // half of it along a pair at 45°
  EXPECT_NEAR(change("flat_parting"), 0.0, 0.05);
  EXPECT_NEAR(change("closing_share"), -0.25, 0.05);  // a quarter of 2 %
}

}  // namespace
}  // namespace pendular::diagnosis
