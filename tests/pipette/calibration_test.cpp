#include "pipette/calibration.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "mutation.h"
#include "pipette/phantom.h"
#include "places.h"
#include "scratch.h"

namespace pendular::pipette {
namespace {

const char* const kGood = R"([camera]
um_per_pixel = 1.37
um_per_pixel_sigma = 0.01
frame_rate_hz = 10
[pipette]
stiffness_n_per_m = 40
stiffness_sigma_n_per_m = 2
[stage]
speed_um_s = 5
[test]
direction = "normal"
pull_direction_px = [2, 0]
[regions]
bead_fixed_px = [100, 30, 70, 70]
bead_free_px = [30, 30, 70, 70]
pipette_px = [10, 40, 16, 16]
reference_px = [0, 100, 30, 20]
)";

TEST(Calibration, IsReadInSiUnits) {
  const Calibration c = parse_calibration(kGood, "cal.toml");
  EXPECT_DOUBLE_EQ(c.metres_per_pixel, 1.37e-6);
  EXPECT_DOUBLE_EQ(c.stage_speed, 5e-6);
  EXPECT_EQ(c.pull, Point(1.0, 0.0));
  EXPECT_EQ(c.bead_fixed->x, 100);
  EXPECT_EQ(c.reference.height, 20);
}

TEST(Calibration, SurvivesWritingAndReading) {
  Calibration c = parse_calibration(kGood, "cal.toml");
  c.direction = Direction::tangential;
  const Calibration back = parse_calibration(to_toml(c), "cal.toml");
  EXPECT_EQ(to_toml(back), to_toml(c));
  c.bead_fixed = c.bead_free = c.pipette = std::nullopt;
  EXPECT_EQ(to_toml(parse_calibration(to_toml(c), "cal.toml")), to_toml(c));
}

TEST(Calibration, OfTheSamplesFolderIsGood) {
  EXPECT_NO_THROW(read_calibration(fs::path(pendular::test::source_folder()) / "samples" / "pipette" /
                                   "calibration.toml"));
}

struct Bad {
  const char* name;
  const char* from;
  const char* to;  ///< replaces the first `from`
  const char* expected;
};

class BadCalibration : public testing::TestWithParam<Bad> {};

TEST_P(BadCalibration, IsOneLineNamingTheKey) {
  std::string text = kGood;
  const auto& bad = GetParam();
  const auto place = text.find(bad.from);
  ASSERT_NE(place, std::string::npos);
  text.replace(place, std::string(bad.from).size(), bad.to);
  try {
    parse_calibration(text, "cal.toml");
    FAIL() << "was accepted";
  } catch (const BadInput& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(bad.expected), std::string::npos) << what;
    EXPECT_EQ(what.find("cal.toml"), 0u) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadCalibration,
    testing::Values(
        Bad{"NoStiffnessSigma", "stiffness_sigma_n_per_m = 2\n", "",
            "pipette.stiffness_sigma_n_per_m is missing"},
        Bad{"NoScaleSigma", "um_per_pixel_sigma = 0.01\n", "", "camera.um_per_pixel_sigma is missing"},
        Bad{"ZeroSigma", "stiffness_sigma_n_per_m = 2", "stiffness_sigma_n_per_m = 0",
            "stiffness_sigma_n_per_m: found 0"},
        Bad{"WideSigma", "stiffness_sigma_n_per_m = 2", "stiffness_sigma_n_per_m = 30", "at most half"},
        Bad{"UnknownKey", "frame_rate_hz", "frame_rate_fps", "nearest known one is \"camera.frame_rate_hz\""},
        Bad{"UnknownKeyLine", "frame_rate_hz", "frame_rate_fps", "cal.toml:4:"},
        Bad{"NegativeScale", "um_per_pixel = 1.37", "um_per_pixel = -1.37", "found -1.37"},
        Bad{"NotANumber", "speed_um_s = 5", "speed_um_s = \"fast\"", "stage.speed_um_s"},
        Bad{"Nan", "speed_um_s = 5", "speed_um_s = nan", "stage.speed_um_s"},
        Bad{"Direction", "\"normal\"", "\"shear\"", "expected \"normal\" or \"tangential\""},
        Bad{"NoPull", "pull_direction_px = [2, 0]", "pull_direction_px = [0, 0]", "expected a direction"},
        Bad{"ShortRegion", "[0, 100, 30, 20]", "[0, 100, 30]", "regions.reference_px"},
        Bad{"FractionOfAPixel", "[0, 100, 30, 20]", "[0.5, 100, 30, 20]", "whole pixels"},
        Bad{"NegativeRegion", "[0, 100, 30, 20]", "[-4, 100, 30, 20]", "regions.reference_px"},
        Bad{"HugeRegion", "[0, 100, 30, 20]", "[0, 100, 3e9, 20]", "regions.reference_px"},
        Bad{"NoReference", "reference_px = [0, 100, 30, 20]\n", "", "regions.reference_px is missing"},
        Bad{"OneBead", "bead_free_px = [30, 30, 70, 70]\n", "", "regions.bead_free_px is missing"},
        Bad{"AutoAndGiven", "[regions]\n", "[regions]\nbeads = \"auto\"\n", "either"},
        Bad{"NotASection", "[camera]\n", "camera = 3\n[x]\n", "expected a section"},
        Bad{"NotToml", "[camera]", "[camera", "cal.toml:1"}),
    [](const auto& test) { return test.param.name; });

TEST(Mutation, NoDamageToACalibrationCrashesItsReader) {
  test::ScratchFolder folder;
  test::read_mutations(folder / "cal.toml", kGood, 1000,
                       [](const fs::path& path) { read_calibration(path); });
}

}  // namespace
}  // namespace pendular::pipette
