#include "diagnosis_report/place_figures.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "diagnosis_report/report_folder.h"
#include "scratch.h"

namespace pendular::diagnosis_report {
namespace {

diagnosis::Place three_beads() {
  diagnosis::Place place;
  place.observation = "scan", place.strain = 0.015, place.words = "Two beads stand out.";
  place.ids = {4, 7, 9};
  place.rest = {{0, 0, 0}, {2e-4, 0, 1e-4}, {0, 2e-4, 3e-4}};
  place.diameter = {2e-4, 2e-4, 2e-4};
  place.misfit = {{{1e-6, 0, 0}, {0, 0, 0}, {0, -2e-6, 0}}, {1.0, 3.0, 4.0}, 2.0};
  place.stiffness = {{0.0, -0.5, 0.1}, {0.1, 0.1, 0.2}, 3.0, 2, 1.0};
  place.cut = 2.0;
  return place;
}

TEST(PlaceFiles, ParaViewFileIsReadBackWithBothFields) {
  const test::ScratchFolder scratch;
  write_polydata(scratch / "place.vtp", place_polydata(three_beads()));
  const PolyTable table = read_polydata(scratch / "place.vtp");
  ASSERT_EQ(table.points.size(), 3u);
  EXPECT_NEAR(table.points[1].x(), 200.0, 1e-9);
  EXPECT_EQ(integers(table, true, "bead_id", "place"), (std::vector<std::int64_t>{4, 7, 9}));
  EXPECT_EQ(integers(table, true, "stands_out", "place"), (std::vector<std::int64_t>{0, 1, 1}));
  EXPECT_EQ(numbers(table, true, "misfit", "place"), (std::vector<double>{1.0, 3.0, 4.0}));
  EXPECT_NEAR(numbers(table, true, "stiffness_change_percent", "place")[1], -39.347, 1e-3);
  EXPECT_NEAR(vectors(table, true, "difference_um", "place")[2].y(), -2.0, 1e-9);
  EXPECT_EQ(table.text_fields.at("words"), "Two beads stand out.");
}

TEST(PlaceFiles, PicturesAreDrawnWithTheirTable) {
  const auto figures = place_figures({three_beads()});
  ASSERT_EQ(figures.size(), 2u);
  for (const auto& figure : figures) {
    EXPECT_EQ(std::get<viz::Image>(figure.picture).width, 1200);
    EXPECT_EQ(figure.data.rows.size(), 3u);
    EXPECT_FALSE(figure.caption.empty());
  }
  EXPECT_EQ(figures[0].data.name, "place_misfit_scan");
}

TEST(PlaceFiles, WithoutADisplayTheNumbersAreThere) {
  const test::ScratchFolder scratch;
  const char* display = std::getenv("DISPLAY");
  const std::string path = std::getenv("PATH"), former = display != nullptr ? display : "";
  ::unsetenv("DISPLAY");
  ::setenv("PATH", scratch.path().c_str(), 1);  // where there is no Xvfb
  diagnosis::Diagnosis found;
  found.places = {three_beads()};
  EXPECT_THROW(write_report_folder(scratch / "out", found), ComputationFailed);
  ::setenv("PATH", path.c_str(), 1);
  if (!former.empty()) ::setenv("DISPLAY", former.c_str(), 1);
  EXPECT_TRUE(fs::exists(scratch / "out/diagnosis.json"));
  EXPECT_TRUE(fs::exists(scratch / "out/place_scan.vtp"));
  EXPECT_FALSE(fs::exists(scratch / "out/report.html"));
}

}  // namespace
}  // namespace pendular::diagnosis_report
