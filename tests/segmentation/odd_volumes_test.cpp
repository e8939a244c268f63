// Volumes as they come, which a phantom is not: cut, padded, saturated, with slices lost, beads broken.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "comparison.h"
#include "phantom/phantom.h"
#include "segmentation/search/padding.h"
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
  const Volume part = part_of(whole(), {{60, 0, 0}, whole().size});  // no tube is seen in what is left
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

/// With so many voxels of one value before and after it along each axis.
Volume padded(const Volume& volume, const std::array<std::size_t, 3>& before,
              const std::array<std::size_t, 3>& after, std::uint16_t value) {
  Volume wide{{}, volume.spacing, volume.origin, std::vector<std::uint16_t>()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wide.size[axis] = before[axis] + volume.size[axis] + after[axis];
    wide.origin[static_cast<Eigen::Index>(axis)] -= volume.spacing * static_cast<double>(before[axis]);
  }
  auto& to = grey_of(wide);
  to.assign(wide.voxels(), value);
  const auto& from = std::get<std::vector<std::uint16_t>>(volume.pixels);
  for (std::size_t k = 0; k < volume.size[2]; ++k)
    for (std::size_t j = 0; j < volume.size[1]; ++j)
      std::copy_n(
          from.begin() + static_cast<std::ptrdiff_t>((k * volume.size[1] + j) * volume.size[0]),
          volume.size[0],
          to.begin() + static_cast<std::ptrdiff_t>(
                           ((k + before[2]) * wide.size[1] + j + before[1]) * wide.size[0] + before[0]));
  return wide;
}

TEST(OddVolumes, PaddingChangesNothingButTheWords) {
  const Segmentation& before = found_in_whole();
  for (const std::uint16_t value : {0, 65535}) {
    const Segmentation found = segment(padded(whole(), {20, 5, 90}, {0, 60, 40}, value));
    EXPECT_EQ(found.warnings.size(), before.warnings.size() + 1);
    EXPECT_TRUE(says(found.warnings, "outer planes hold one grey value"));
    ASSERT_EQ(found.beads.size(), before.beads.size());
    for (std::size_t n = 0; n < found.beads.size(); ++n) {
      EXPECT_LT((found.beads[n].centre - before.beads[n].centre).norm(), 1e-6 * voxel);
      EXPECT_DOUBLE_EQ(found.beads[n].diameter, before.beads[n].diameter);
      EXPECT_EQ(found.beads[n].boundary, before.beads[n].boundary);
    }
    ASSERT_TRUE(found.specimen);
    EXPECT_DOUBLE_EQ(found.porosity, before.porosity);
  }
}

TEST(OddVolumes, OneGreyValueOfTheSpecimenIsNoPadding) {
  Volume still = whole();  // air has one value, within the packing and in slices before and after it
  const auto air = static_cast<std::uint16_t>(found_in_whole().levels.threshold);
  for (auto& grey : grey_of(still)) grey = std::max(grey, air);
  const Volume wide = padded(still, {0, 0, 30}, {0, 0, 30}, air);
  EXPECT_EQ(without_padding(wide), (Box{{}, wide.size}));
  EXPECT_NE(without_padding(padded(still, {0, 0, 30}, {0, 0, 30}, 0)), (Box{{}, wide.size}));
}

TEST(OddVolumes, CornersOfATurnedVolumeAreNoGreyLevel) {
  Volume turned = whole();  // about x by as much as cuts its corners off, two fifths of the voxels
  const double y = 0.5 * static_cast<double>(turned.size[1] - 1),
               z = 0.5 * static_cast<double>(turned.size[2] - 1);
  std::size_t n = 0;
  for (std::size_t k = 0; k < turned.size[2]; ++k)
    for (std::size_t j = 0; j < turned.size[1]; ++j)
      for (std::size_t i = 0; i < turned.size[0]; ++i, ++n)
        if (std::abs(static_cast<double>(j) - y) / y + std::abs(static_cast<double>(k) - z) / z > 1.1)
          grey_of(turned)[n] = 0;
  const Segmentation found = segment(turned);
  EXPECT_NEAR(found.levels.threshold, found_in_whole().levels.threshold,
              0.02 * (found.levels.bright - found.levels.dark));
  EXPECT_GT(found.beads.size(), found_in_whole().beads.size() / 3);
}

TEST(OddVolumes, AHalfWithoutAnythingIsLeftOut) {
  Volume volume = whole();
  auto& grey = grey_of(volume);
  const std::size_t kept = volume.size[2] / 2;
  std::fill(grey.begin() + static_cast<std::ptrdiff_t>(kept * volume.size[0] * volume.size[1]), grey.end(),
            0);
  const Segmentation found = segment(volume);
  EXPECT_TRUE(says(found.warnings, fmt::format("z 0 to {}", kept - 1)));
  const Volume part = part_of(whole(), {{}, {volume.size[0], volume.size[1], kept}});
  const auto result = test::compare(beads_in(part, 100e-6), found.beads, voxel);
  EXPECT_EQ(result.missed, 0);
  EXPECT_LT(result.centre_rms, 0.02);
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
