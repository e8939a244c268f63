// Volumes as they come, which a phantom is not: cut, padded, saturated, with slices lost, beads broken.
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "comparison.h"
#include "phantom/phantom.h"
#include "segmentation/segment.h"

namespace pendular::segmentation {
namespace {

constexpr double voxel = 7e-6;

const Volume& whole() {
  static const Volume made = [] {
    Sample sample = test::small_sample();
    sample.phantom.voxel = voxel;
    sample.phantom.noise = 0.1;
    sample.phantom.correlated_noise = 0.0;
    return phantom::make_phantom(test::small_packing(), sample.phantom, 1);
  }();
  return made;
}

const Segmentation& found_in_whole() {
  static const Segmentation found = segment(whole());
  return found;
}

std::vector<std::uint16_t>& grey_of(Volume& volume) {
  return std::get<std::vector<std::uint16_t>>(volume.pixels);
}

bool says(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// Without the first slices along each axis and the last.
Volume cut(const Volume& volume, const std::array<std::size_t, 3>& first,
           const std::array<std::size_t, 3>& last) {
  const auto& from = std::get<std::vector<std::uint16_t>>(volume.pixels);
  Volume part{{}, volume.spacing, volume.origin, std::vector<std::uint16_t>()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    part.size[axis] = volume.size[axis] - first[axis] - last[axis];
    part.origin[static_cast<Eigen::Index>(axis)] += volume.spacing * static_cast<double>(first[axis]);
  }
  for (std::size_t k = 0; k < part.size[2]; ++k)
    for (std::size_t j = 0; j < part.size[1]; ++j) {
      const auto row =
          from.begin() + static_cast<std::ptrdiff_t>(
                             ((k + first[2]) * volume.size[1] + j + first[1]) * volume.size[0] + first[0]);
      grey_of(part).insert(grey_of(part).end(), row, row + static_cast<std::ptrdiff_t>(part.size[0]));
    }
  return part;
}

/// What of the packing has its centre within the volume, by at least `margin`.
std::vector<Bead> beads_in(const Volume& volume, double margin) {
  std::vector<Bead> beads = test::small_packing().beads;
  std::erase_if(beads, [&](const Bead& bead) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      const double low = volume.origin[a] + margin,
                   high = volume.origin[a] + voxel * static_cast<double>(volume.size[axis] - 1) - margin;
      if (bead.centre[a] < low || bead.centre[a] > high) return true;
    }
    return false;
  });
  return beads;
}

TEST(OddVolumes, BeadsCutByThePictureAndAWallNobodySawDoNotPullAtTheirNeighbours) {
  const Volume part = cut(whole(), {60, 0, 0}, {0, 0, 0});  // no tube is seen in what is left
  const Segmentation found = segment(part);
  EXPECT_FALSE(found.specimen);
  const auto result = test::compare(beads_in(part, 100e-6), found.beads, voxel);
  EXPECT_EQ(result.missed, 0);
  EXPECT_LT(result.centre_rms, 0.02);
  EXPECT_LT(std::abs(result.diameter_bias), 0.02);
  EXPECT_NEAR(result.pull, 1.0, 0.4);
}

TEST(OddVolumes, ZerosBeyondTheFieldOfViewChangeNothing) {
  Volume padded = whole();
  const double middle = 0.5 * static_cast<double>(padded.size[0] - 1);
  std::size_t n = 0;
  for (std::size_t k = 0; k < padded.size[2]; ++k)
    for (std::size_t j = 0; j < padded.size[1]; ++j)
      for (std::size_t i = 0; i < padded.size[0]; ++i, ++n)
        if (std::hypot(static_cast<double>(i) - middle, static_cast<double>(j) - middle) > middle)
          grey_of(padded)[n] = 0;
  const Segmentation found = segment(padded), &before = found_in_whole();
  EXPECT_TRUE(found.warnings.empty());
  ASSERT_TRUE(found.specimen);
  EXPECT_NEAR(found.porosity, before.porosity, 1e-3);
  const auto result = test::compare(test::small_packing().beads, found.beads, voxel);
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(result.centre_rms, 0.015);
}

TEST(OddVolumes, GreyValuesThatAreCutOffAreNoticed) {
  Volume saturated = whole();
  const auto bright = static_cast<std::uint16_t>(found_in_whole().levels.bright);
  for (auto& grey : grey_of(saturated)) grey = std::min(grey, bright);
  const Segmentation found = segment(saturated);
  EXPECT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings, "of the voxels have the greatest grey value"));
}

TEST(OddVolumes, LostAndRepeatedSlicesAreNoticed) {
  Volume volume = whole();
  const std::size_t slice = volume.size[0] * volume.size[1];
  const auto at = [&](std::size_t k) {
    return grey_of(volume).begin() + static_cast<std::ptrdiff_t>(k * slice);
  };
  std::fill(at(60), at(63), 0);
  std::copy(at(79), at(80), at(80));
  grey_of(volume).erase(at(120), at(128));
  volume.size[2] -= 8;
  const Segmentation found = segment(volume);
  EXPECT_TRUE(says(found.warnings, "slices 60 to 62, from 0 on: one grey value"));
  EXPECT_TRUE(says(found.warnings, "slice 80, from 0 on: the same as"));
  EXPECT_TRUE(says(found.warnings, "slice 120, from 0 on: not a continuation"));
}

TEST(OddVolumes, AHalfWithoutAnythingIsNamed) {
  Volume volume = whole();
  auto& grey = grey_of(volume);
  std::fill(grey.begin() + std::ssize(grey) / 2, grey.end(), 0);
  try {
    segment(volume);
    FAIL() << "found beads";
  } catch (const BadInput& error) {
    EXPECT_TRUE(says({error.what()}, "one grey value throughout"));
  }
}

/// Takes glass away within a ball, where it lies beyond a plane (all of it with a plane far off).
void carve(Volume& volume, const Vec3& centre, double radius, const Vec3& normal, double beyond,
           double depth) {
  const Vec3 c = (centre - volume.origin) / volume.spacing;
  const double r = radius / volume.spacing;
  std::array<std::size_t, 3> low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(c[axis] - r - 3.0);
    high[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(c[axis] + r + 4.0);
  }
  const auto step = [](double distance) {
    return 0.5 * std::erfc(-distance / M_SQRT2);
  };  // a blur of a voxel
  for (std::size_t k = low[2]; k < high[2]; ++k)
    for (std::size_t j = low[1]; j < high[1]; ++j)
      for (std::size_t i = low[0]; i < high[0]; ++i) {
        const Vec3 p = Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) - c;
        auto& grey = grey_of(volume)[(k * volume.size[1] + j) * volume.size[0] + i];
        const double share = step(r - p.norm()) * step(p.dot(normal) - beyond / volume.spacing);
        grey = static_cast<std::uint16_t>(std::max(0.0, static_cast<double>(grey) - share * depth));
      }
}

TEST(OddVolumes, PoresAreNoBeadsAndBrokenBeadsAreLeftOut) {
  Volume volume = whole();
  const GreyLevels levels = found_in_whole().levels;
  const double depth = levels.bright - levels.dark;
  std::vector<Bead> intact;
  const auto& beads = test::small_packing().beads;
  for (std::size_t n = 0; n < beads.size(); ++n) {
    const auto draw = [&](std::uint64_t k) { return random_normal(7, 10 * n + k); };
    const Vec3 direction = Vec3(draw(0), draw(1), draw(2)).normalized();
    const double radius = 0.5 * beads[n].diameter;
    if (n % 20 == 0) {
      carve(volume, beads[n].centre, radius, direction, 0.3 * radius, depth);
      continue;
    }
    intact.push_back(beads[n]);
    if (n % 3 == 0)
      carve(volume, beads[n].centre + 0.6 * radius * direction, 0.22 * radius, direction, -radius, depth);
  }
  const Segmentation found = segment(volume);
  EXPECT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings, "objects rejected, not in the table (boundary not spherical)"));
  const auto result = test::compare(intact, found.beads, voxel);
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(result.centre_rms, 0.02);
  EXPECT_LT(std::abs(result.diameter_bias), 0.02);
}

}  // namespace
}  // namespace pendular::segmentation
