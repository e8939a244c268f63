#include "segmentation/segment.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <set>

#include "balls.h"
#include "base/error.h"
#include "comparison.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "phantom/phantom.h"
#include "picture.h"
#include "scratch.h"
#include "segmentation/qa/qa.h"
#include "volume/resample.h"

namespace pendular::segmentation {
namespace {

/// Voxels of 1 um.
std::vector<Bead> beads_of(const std::vector<test::TrueBall>& balls) {
  std::vector<Bead> beads;
  for (const auto& ball : balls) {
    beads.emplace_back();
    beads.back().centre = 1e-6 * ball.centre;
    beads.back().diameter = 2e-6 * ball.radius;
  }
  return beads;
}

struct PhantomCase {
  const char* name;
  double voxel_um, noise, correlated_noise, contrast, centre_rms, bias;
  double beam_hardening = 0.0, rings = 0.0;
};

void PrintTo(const PhantomCase& c, std::ostream* out) {
  *out << c.name;
}

class OnPhantom : public testing::TestWithParam<PhantomCase> {};

TEST_P(OnPhantom, FindsEveryBead) {
  const PhantomCase& c = GetParam();
  Sample sample = test::small_sample();
  sample.phantom.voxel = c.voxel_um * 1e-6;
  sample.phantom.noise = c.noise;
  sample.phantom.correlated_noise = c.correlated_noise;
  sample.phantom.polymer_contrast = c.contrast;
  sample.phantom.beam_hardening = c.beam_hardening;
  sample.phantom.rings = c.rings;
  const Packing& packing = test::small_packing();
  const Volume volume = phantom::make_phantom(packing, sample.phantom, 1);
  const Segmentation found = segment(volume);
  const test::Comparison result = test::compare(packing.beads, found.beads, volume.spacing);
  SCOPED_TRACE(fmt::format("centre rms {:.4f}, diameter bias {:.4f} voxels, pull {:.2f}", result.centre_rms,
                           result.diameter_bias, result.pull));
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(result.centre_rms, c.centre_rms);
  EXPECT_LT(std::abs(result.diameter_bias), c.bias);
  EXPECT_NEAR(result.pull, 1.0, 0.35);
  EXPECT_TRUE(found.bright_beads);
  EXPECT_NEAR(found.blur / volume.spacing, std::hypot(1.0, std::sqrt(1.0 / 12.0)), 0.05);
  ASSERT_TRUE(found.specimen);
  const double voxel = volume.spacing;
  EXPECT_NEAR(found.specimen->diameter, packing.specimen.diameter, 2.0 * voxel);
  EXPECT_NEAR(found.specimen->height, packing.specimen.height, 2.0 * voxel);
  EXPECT_NEAR(found.specimen->axis_x, packing.specimen.axis_x, 0.5 * voxel);
  EXPECT_NEAR(found.specimen->bottom, packing.specimen.bottom, voxel);
}

INSTANTIATE_TEST_SUITE_P(Segment, OnPhantom,
                         testing::Values(PhantomCase{"Across40", 5.0, 0.1, 0.0, 0.3, 0.02, 0.02},
                                         PhantomCase{"BeamHardening", 5.0, 0.1, 0.0, 0.3, 0.02, 0.02, 0.2},
                                         PhantomCase{"Rings", 5.0, 0.1, 0.0, 0.3, 0.02, 0.02, 0.0, 0.1},
                                         PhantomCase{"NoiseOfAThird", 5.0, 0.3, 0.0, 0.3, 0.02, 0.02},
                                         PhantomCase{"Across20", 10.0, 0.1, 0.0, 0.3, 0.04, 0.05},
                                         PhantomCase{"Across14", 14.0, 0.1, 0.0, 0.3, 0.06, 0.05},
                                         PhantomCase{"Across8", 25.0, 0.1, 0.0, 0.3, 0.09, 0.12},
                                         PhantomCase{"Noisy", 8.0, 0.3, 0.0, 0.3, 0.1, 0.1},
                                         PhantomCase{"CorrelatedNoise", 8.0, 0.05, 0.05, 0.3, 0.1, 0.1},
                                         PhantomCase{"BrightPolymer", 8.0, 0.1, 0.0, 0.45, 0.05, 0.05}),
                         [](const auto& which) { return which.param.name; });

/// Down to half of the mean.
TEST(Segment, FindsEveryBeadWhereDiametersVaryByAFifth) {
  Sample sample = test::small_sample();
  sample.beads.diameter_sd = 0.2 * sample.beads.diameter;
  const Packing packing = generate_packing(sample, 3);
  const auto smallest =
      std::min_element(packing.beads.begin(), packing.beads.end(),
                       [](const Bead& a, const Bead& b) { return a.diameter < b.diameter; });
  ASSERT_LT(smallest->diameter, 0.6 * sample.beads.diameter);
  sample.phantom.noise = 0.1;
  const Volume volume = phantom::make_phantom(packing, sample.phantom, 1);
  const Segmentation found = segment(volume);
  const test::Comparison result = test::compare(packing.beads, found.beads, volume.spacing);
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(std::abs(result.diameter_bias), 0.05);
}

TEST(Segment, LabelsBelongToTheNearestBall) {
  const std::vector<test::TrueBall> balls = {
      {Vec3(20, 20, 20), 9.0}, {Vec3(40, 20, 20), 10.0}, {Vec3(30, 38, 22), 9.5}};
  const Volume volume = test::ball_volume({60, 60, 44}, balls, 1.0, 0.05);
  const Segmentation found = segment(volume);
  ASSERT_EQ(found.beads.size(), 3u);
  EXPECT_TRUE(found.grains.empty());
  EXPECT_FALSE(found.specimen);
  const Volume labels = label_volume(volume, found);
  const auto& pixels = std::get<std::vector<std::uint16_t>>(labels.pixels);
  for (std::size_t n = 0; n < found.beads.size(); ++n) {
    const double count = static_cast<double>(std::count(pixels.begin(), pixels.end(), n + 1));
    const double radius = 0.5 * found.beads[n].diameter / volume.spacing;
    const double half_way = radius - 1.0 / radius;  // the blur of 1 voxel draws the half-way level in by s²/R
    EXPECT_NEAR(count / (4.0 / 3.0 * M_PI * std::pow(half_way, 3)), 1.0, 0.015);
  }
}

/// Of a circle in a slice's picture, the share that is drawn in green.
double drawn_in_green(const cv::Mat& image, double scale, double height, const Vec3& centre, double radius) {
  int drawn = 0;
  for (int k = 0; k < 64; ++k) {
    const double x = centre.x() + radius * std::cos(M_PI * k / 32.0),
                 y = centre.y() + radius * std::sin(M_PI * k / 32.0);
    drawn += test::shows(image, (x + 0.5) * scale - 0.5, (height - 0.5 - y) * scale - 0.5, {60, 220, 60}, 60);
  }
  return drawn / 64.0;
}

TEST(Segment, PicturesShowWhatWasFound) {
  const double level = 21.0;  // of the middle slice
  const std::vector<test::TrueBall> balls = {
      {Vec3(20, 20, 20.2), 9.0}, {Vec3(40, 20, 21), 10.0}, {Vec3(30, 38, 22), 9.5}};
  const Volume volume = test::ball_volume({60, 60, 44}, balls, 1.0, 0.05);
  const Segmentation found = segment(volume);
  ASSERT_EQ(found.beads.size(), 3u);
  const test::ScratchFolder folder;
  write_qa(folder.path(), volume, found);

  const cv::Mat slice = test::picture(folder / "slice_xy_2.png");
  ASSERT_EQ(slice.size(), cv::Size(900, 900));
  for (const auto& ball : balls) {
    const double cut = std::sqrt(ball.radius * ball.radius - std::pow(ball.centre.z() - level, 2));
    EXPECT_GT(drawn_in_green(slice, 15.0, 60.0, ball.centre, cut), 0.95);
    EXPECT_LT(drawn_in_green(slice, 15.0, 60.0, ball.centre, cut - 2.0), 0.05);
  }

  // What beads leave is noise of 0.05 about the middle grey: the grey scale spans two contrasts.
  cv::Scalar mean, sd;
  cv::meanStdDev(test::picture(folder / "residual_xy.png"), mean, sd);
  EXPECT_NEAR(mean[0], 127.5, 2.0);
  EXPECT_NEAR(sd[0], 0.05 * 127.5, 1.5);

  // A bar for each twentieth of a voxel in which a centre lies.
  std::size_t bars = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::set<int> occupied;
    for (const Bead& bead : found.beads) {
      const double voxel = (bead.centre[axis] - volume.origin[axis]) / volume.spacing;
      occupied.insert(static_cast<int>(20.0 * (voxel - std::floor(voxel))));
    }
    bars += occupied.size();
  }
  const cv::Mat positions = test::picture(folder / "fractional_positions.png");
  EXPECT_EQ(test::pixels_of(positions.row(268), {255, 150, 60}).size(), 14 * bars);
}

TEST(Segment, VoxelsTwiceAsHighAsTheyAreWide) {
  const std::vector<test::TrueBall> balls = {
      {Vec3(20.3, 20.1, 20.4), 9.0}, {Vec3(40.2, 20.6, 20.2), 10.0}, {Vec3(30.5, 38.3, 22.7), 9.5}};
  const Volume volume = test::ball_volume({60, 60, 44}, balls, 1.0, 0.05);
  const auto& grey = std::get<std::vector<std::uint16_t>>(volume.pixels);
  std::vector<std::uint16_t> pairs(grey.size() / 2);  // means of two slices
  const std::size_t slice = volume.size[0] * volume.size[1];
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const std::size_t k = n / slice, first = 2 * k * slice + n % slice;
    pairs[n] = static_cast<std::uint16_t>((grey[first] + grey[first + slice]) / 2);
  }
  const Volume high{{60, 60, 22}, volume.spacing, 0.5 * volume.spacing * Vec3::UnitZ(), pairs};
  const Segmentation found = segment(resampled(high, {1.0, 1.0, 2.0}));
  const test::Comparison result = test::compare(beads_of(balls), found.beads, volume.spacing);
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(result.centre_rms, 0.02);
  EXPECT_LT(std::abs(result.diameter_bias), 0.1);
}

/// Eight bits, more than 2^31 voxels, all but the last corner of them a hole in the file.
std::vector<test::TrueBall> write_sparse_volume(const fs::path& path, std::size_t edge) {
  std::vector<test::TrueBall> balls;
  for (int n = 0; n < 27; ++n)
    balls.push_back(
        {Vec3(41.3 + n % 3 * 81.0, 41.7 + n / 3 % 3 * 81.0, 42.1 + n / 9 * 81.0), 40.0 - 0.1 * n});
  constexpr std::size_t corner = 256;
  const Volume volume = test::ball_volume({corner, corner, corner}, balls, 1.0, 0.0, 0.0, 200.0);
  const auto& grey = std::get<std::vector<std::uint16_t>>(volume.pixels);
  std::ofstream out(path, std::ios::binary);
  const std::size_t shift = edge - corner;
  for (std::size_t k = 0; k < corner; ++k)
    for (std::size_t j = 0; j < corner; ++j) {
      std::string row;
      for (std::size_t i = 0; i < corner; ++i)
        row.push_back(static_cast<char>(grey[(k * corner + j) * corner + i]));
      out.seekp(static_cast<std::streamoff>(((shift + k) * edge + shift + j) * edge + shift));
      out.write(row.data(), static_cast<std::streamsize>(row.size()));
    }
  for (test::TrueBall& ball : balls) ball.centre.array() += static_cast<double>(shift);
  return balls;
}

TEST(Segment, MoreVoxelsThanSignedNumbersOf32BitsAndThanMemoryAllows) {
  constexpr std::size_t edge = 1300;
  const test::ScratchFolder folder;
  const auto balls = write_sparse_volume(folder / "v.raw", edge);
  rlimit usual{};
  ::getrlimit(RLIMIT_DATA, &usual);
  const rlimit less_than_the_volume = {2'100'000'000, usual.rlim_max};
  ::setrlimit(RLIMIT_DATA, &less_than_the_volume);
  const Volume volume = read_volume(folder / "v.raw", {1e-6, std::array{edge, edge, edge}, "uint8"});
  const Segmentation found = segment(volume);
  ::setrlimit(RLIMIT_DATA, &usual);
  ASSERT_GT(volume.voxels(), std::size_t{1} << 31);
  const test::Comparison result = test::compare(beads_of(balls), found.beads, volume.spacing);
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.invented, 0);
  EXPECT_LT(result.centre_rms, 0.02);
}

TEST(Segment, FindsDarkBeadsByItself) {
  const std::vector<test::TrueBall> balls = {
      {Vec3(20, 20, 20), 9.0}, {Vec3(40, 20, 22), 6.0}, {Vec3(30, 38, 22), 9.5}};
  const Segmentation found = segment(test::ball_volume({60, 60, 44}, balls, 1.0, 0.05, 40000.0, -20000.0));
  EXPECT_FALSE(found.bright_beads);
  EXPECT_EQ(found.beads.size(), 3u);
}

TEST(Segment, NoBeadsIsBadInput) {
  EXPECT_THROW(segment(test::ball_volume({40, 40, 40}, {}, 1.0, 0.3)), BadInput);
  EXPECT_THROW(segment(test::ball_volume({8, 40, 40}, {{Vec3(4, 20, 20), 3.0}}, 1.0, 0.0)), BadInput);
}

TEST(Segment, SteelOfIrregularGrains) {
  const auto raw = test::shared_data("steel_ct/steel_raw_100.mha"),
             truth = test::shared_data("steel_ct/steel_bw_pore_white_100.mha");
  if (!raw || !truth) GTEST_SKIP() << "no trial data (steel_ct)";
  const Volume volume = read_volume(*raw);
  const Segmentation found = segment(volume);
  EXPECT_TRUE(found.bright_beads);
  EXPECT_FALSE(found.grains.empty());
  EXPECT_NEAR(found.porosity, 0.380, 0.01);
  const Volume labels = label_volume(volume, found), mask = read_volume(*truth);
  const auto& ours = std::get<std::vector<std::uint16_t>>(labels.pixels);
  const auto& pores = std::get<std::vector<std::uint8_t>>(mask.pixels);
  double both = 0.0, either = 0.0;
  for (std::size_t n = 0; n < ours.size(); ++n) {
    both += ours[n] > 0 && pores[n] == 0;
    either += (ours[n] > 0) + (pores[n] == 0);
  }
  EXPECT_GT(2.0 * both / either, 0.9);  // Dice
}

TEST(Segment, AirVoidsInCement) {
  const auto path = test::shared_data("cement_ct/cement_128x128x128.tif");
  if (!path) GTEST_SKIP() << "no trial data (cement_ct)";
  const Segmentation found = segment(read_volume(*path));
  EXPECT_FALSE(found.bright_beads);
  EXPECT_GT(found.beads.size(), 200u);
  EXPECT_LT(found.levels.dark, 40.0);
  EXPECT_NEAR(found.levels.bright, 101.0, 3.0);
}

}  // namespace
}  // namespace pendular::segmentation
