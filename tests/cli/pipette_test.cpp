#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "base/csv.h"
#include "base/files.h"
#include "documented.h"
#include "picture.h"
#include "pipette/frames.h"
#include "pipette/phantom.h"
#include "program.h"
#include "scratch.h"

namespace pendular {
namespace {

using pipette::Phantom;
using test::Outcome;
using test::ScratchFolder;
using test::shell;

/// A short test in `folder`/f with its calibration cal.toml.
void write_test(const ScratchFolder& folder, const Phantom& phantom) {
  fs::create_directories(folder / "f");
  pipette::write_phantom(folder / "f", phantom);
  write_text(folder / "cal.toml", pipette::to_toml(pipette::phantom_calibration(phantom)));
}

TEST(PipetteCommand, WritesWhatThePageSaysWhateverTheThreads) {
  ScratchFolder folder;
  Phantom phantom;
  phantom.dropped = 9;
  phantom.bits = 16;
  write_test(folder, phantom);
  const Outcome outcome =
      shell(folder.path(),
            "$P pipette f --calibration cal.toml -o a.csv --threads 1 --check look --film film.avi && "
            "$P pipette 'f/frame_*.png' --calibration cal.toml -o b.csv --threads 2");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const CsvTable table =
      read_csv(folder / "a.csv", {"time_s", "displacement_um", "force_n", "score", "used"});
  EXPECT_EQ(test::columns_of(folder / "a.csv"), test::documented("`pipette` table"));
  test::expect_documented_keys(folder / "a.json", "`pipette` summary");
  ASSERT_EQ(table.rows(), 60u);
  EXPECT_EQ(table.numbers("used")[9], 0.0);
  EXPECT_NEAR(table.numbers("time_s")[59], 5.9, 1e-9);
  const auto numbers = [](const fs::path& path) {
    std::string text = read_text(path);
    return text.substr(text.find("time_s"));
  };
  EXPECT_EQ(numbers(folder / "a.csv"), numbers(folder / "b.csv"));
  const auto json = nlohmann::json::parse(read_text(folder / "a.json"));
  const double k = json.at("stiffness_n_per_m");
  EXPECT_NEAR(k, 400.0, 4.0 * json.at("fit_sigma").get<double>());
  EXPECT_NEAR(json.at("calibration_sigma").get<double>(), 0.05 * k, 1e-6);
  EXPECT_LT(json.at("interval_90")[0], k);
  EXPECT_GT(json.at("linear_range_um")[1], 3.0);
  EXPECT_EQ(json.at("rejected")[0].at("frame"), 9);
  EXPECT_GT(test::drawn_share(test::picture(folder / "a.png")), 0.005);
  EXPECT_TRUE(read_text(folder / "a.pdf").starts_with("%PDF-"));
  // The outlines of both beads are where the phantom drew them, four pixels to one of a frame.
  const cv::Mat scene = test::picture(folder / "look" / "scene.png");
  for (const auto& colour : {cv::Vec3b(190, 110, 20), cv::Vec3b(0, 120, 240)}) {
    cv::Point2f centre;
    float radius = 0.0f;
    cv::minEnclosingCircle(test::pixels_of(scene, colour, 10), centre, radius);
    // Marks on the edge are 0.7 pixels in radius.
    EXPECT_NEAR(radius / 4.0, 0.5 * phantom.bead_diameter + 0.7, 0.6);
  }
  EXPECT_EQ(test::picture(folder / "look" / "tracks.png").cols, 2 * scene.cols);
  pipette::FrameSource film(folder / "film.avi");
  int frames = 0;
  while (film.next()) ++frames;
  EXPECT_EQ(frames, 60);
  // The film is itself a video that can be read; its frames are larger than the regions say, so no bead is
  // there.
  EXPECT_EQ(shell(folder.path(), "$P pipette film.avi --calibration cal.toml -o c.csv").status, 3);
}

TEST(PipetteCommand, WithoutALinearRangeKeepsTheCurveAndSaysSo) {
  ScratchFolder folder;
  Phantom phantom;
  phantom.bridge_stiffness = 4e6;
  write_test(folder, phantom);
  const Outcome outcome = shell(folder.path(), "$P pipette f --calibration cal.toml -o a.csv --quiet");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.errors.find("no linear range"), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_EQ(read_csv(folder / "a.csv", {"force_n"}).rows(), 60u);
  const auto json = nlohmann::json::parse(read_text(folder / "a.json"));
  for (const char* key :
       {"stiffness_n_per_m", "interval_90", "fit_sigma", "calibration_sigma", "linear_range_um"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
}

struct BadTest {
  const char* name;
  const char* damage;    ///< shell command in the folder, before
  const char* expected;  ///< part of the one line
  int status = 3;
};

class BadPipetteTest : public testing::TestWithParam<BadTest> {};

TEST_P(BadPipetteTest, GivesOneLineAndTheRightStatus) {
  ScratchFolder folder;
  Phantom phantom;
  phantom.loading = 12;
  phantom.unloading = 5;
  write_test(folder, phantom);
  fs::create_directories(folder / "parts");
  // Pictures to damage the sequence with: black, another size, no bead.
  for (const auto& [name, change] : std::initializer_list<std::pair<const char*, void (*)(Phantom&)>>{
           {"black", [](Phantom& p) { p.dropped = 0; }},
           {"wide", [](Phantom& p) { p.width = 300; }},
           {"other", [](Phantom& p) { p.bead_diameter = 12.0, p.neck_diameter = 4.0, p.texture = 0.0; }}}) {
    Phantom part = phantom;
    part.still = 1, part.loading = 1, part.unloading = 0;
    change(part);
    fs::create_directories(folder / "parts" / name);
    pipette::write_phantom(folder / "parts" / name, part);
  }
  const auto& bad = GetParam();
  ASSERT_EQ(shell(folder.path(), bad.damage).status, 0);
  const Outcome outcome = shell(folder.path(), "$P pipette f --calibration cal.toml -o out.csv --quiet");
  EXPECT_EQ(outcome.status, bad.status) << outcome.errors;
  EXPECT_NE(outcome.errors.find(bad.expected), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  for (const char* name : {"out.csv", "out.json", "out.png", "out.pdf"})
    EXPECT_FALSE(fs::exists(folder / name)) << name;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadPipetteTest,
    testing::Values(
        BadTest{"MissingFrames", "rm -r f", "f: no such file"},
        BadTest{"EmptyFolder", "rm f/*", "found no images"},
        BadTest{"NotAVideo", "rm -r f; echo nothing > f", "cannot be read as a video"},
        BadTest{"BrokenImage", "echo nothing > f/frame_0007.png",
                "f/frame_0007.png: cannot be read as an image"},
        BadTest{"SameNumberTwice", "cp f/frame_0003.png f/other_0003.png", "one image per number"},
        BadTest{"NoNumber", "cp f/frame_0003.png f/last.png", "found no number"},
        BadTest{"MixedSizes", "cp parts/wide/frame_0000.png f/frame_0005.png", "expected 220 x 130"},
        BadTest{"TooFew", "rm f/frame_001*.png", "expected at least 16"},
        BadTest{"BlackFirst", "cp parts/black/frame_0000.png f/frame_0000.png", "constant picture"},
        BadTest{"AllBlackAfter",
                "for k in f/*; do [ $k = f/frame_0000.png ] || cp parts/black/frame_0000.png $k; done",
                "found 1 frames that can be used"},
        BadTest{"LostBead",
                "for k in 06 07 08 09 10 11; do cp parts/other/frame_0000.png f/frame_00$k.png; done",
                "lost from here on"},
        BadTest{"LostBeadFrame",
                "for k in 06 07 08 09 10 11; do cp parts/other/frame_0001.png f/frame_00$k.png; done",
                "frame_0006.png"},
        BadTest{"NoBead", "cp parts/other/frame_0000.png f/frame_0000.png", "expected a bead"},
        BadTest{"NoBeadsToFind",
                "cp parts/other/frame_0000.png f/frame_0000.png; sed -i 's/^bead_free.*//; "
                "s/^bead_fixed.*/beads = "
                "\"auto\"/' cal.toml",
                "found no two touching circles"},
        BadTest{"RegionOutside", "sed -i 's/^reference_px.*/reference_px = [200, 100, 40, 20]/' cal.toml",
                "within the image of 220 x 130"},
        BadTest{"EmptyRegion", "sed -i 's/^reference_px.*/reference_px = [180, 90, 10, 10]/' cal.toml",
                "reference"},
        BadTest{"WrongDirection", "sed -i 's/\"normal\"/\"tangential\"/' cal.toml",
                "expected 90 for a tangential test"},
        BadTest{"SwappedRegions",
                "sed -i 's/^bead_fixed/bead_x/; s/^bead_free/bead_fixed/; s/^bead_x/bead_free/' cal.toml",
                "regions swapped?"},
        BadTest{"NoSigma", "sed -i '/stiffness_sigma/d' cal.toml",
                "pipette.stiffness_sigma_n_per_m is missing"},
        BadTest{"UnknownKey", "sed -i 's/frame_rate_hz/frame_rate/' cal.toml", "camera.frame_rate_hz"},
        BadTest{"MissingCalibration", "rm cal.toml", "cal.toml: no such file"}),
    [](const auto& test) { return test.param.name; });

TEST(PipetteCommand, WrongNamesAreWrongUsage) {
  ScratchFolder folder;
  EXPECT_EQ(shell(folder.path(), "$P pipette f -o a.csv").status, 2);
  EXPECT_EQ(shell(folder.path(), "$P pipette f --calibration cal.toml -o a.txt").status, 2);
  EXPECT_EQ(shell(folder.path(), "$P pipette f --calibration cal.toml -o a.csv --film a.gif").status, 2);
}

}  // namespace
}  // namespace pendular
