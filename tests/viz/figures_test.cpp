#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planted_run.h"
#include "scratch.h"
#include "svg.h"
#include "viz/band_plot.h"
#include "viz/bridge_plot.h"
#include "viz/matrix_plot.h"
#include "viz/pipette_plot.h"
#include "viz/plot.h"
#include "viz/row_plot.h"
#include "viz/series_plot.h"

namespace pendular {
namespace {

using test::areas, test::lines, test::markers, test::svg_of, test::SvgArea, test::SvgWords;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char *kBlue = "31,90,165", *kOrange = "214,106,20", *kRed = "190,40,30",
                     *kGrey = "232,232,232", *kFrame = "20,20,20", *kBars = "236,190,140";

std::array<int, 3> rgb_of(const SvgArea& area) {
  std::array<int, 3> rgb{};
  std::string text = area.colour;
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream(text) >> rgb[0] >> rgb[1] >> rgb[2];
  return rgb;
}

/// The cells of a matrix from left to right: areas wider than a colour bar.
std::vector<SvgArea> cells(const std::string& svg) {
  auto found = areas(svg);
  std::erase_if(found, [](const SvgArea& area) { return area.width() < 100.0; });
  std::stable_sort(found.begin(), found.end(),
                   [](const SvgArea& a, const SvgArea& b) { return a.left() < b.left(); });
  return found;
}

const SvgWords& find_words(const std::vector<SvgWords>& all, const std::string& text) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const SvgWords& w) { return w.text == text; });
  if (at == all.end()) throw std::runtime_error("the figure does not say " + text);
  return *at;
}

TEST(MatrixPlot, PositiveIsRedNegativeIsBlueAndNothingIsGrey) {
  const auto draw = [&](double left, double right) {
    return cells(
        svg_of(viz::matrix_figure({{"row"}, {"first", "second"}, {left, right}, {}, {}, "z", true, 5.0})));
  };
  const auto rising = draw(-5.0, 5.0);
  ASSERT_EQ(rising.size(), 2u);
  EXPECT_GT(rgb_of(rising[0])[2], rgb_of(rising[0])[0] + 60);
  EXPECT_GT(rgb_of(rising[1])[0], rgb_of(rising[1])[2] + 60);
  const auto falling = draw(5.0, -5.0);
  EXPECT_EQ(falling[0].colour, rising[1].colour);
  EXPECT_EQ(falling[1].colour, rising[0].colour);
  const auto half = draw(kNone, 5.0);
  ASSERT_EQ(half.size(), 2u);
  EXPECT_EQ(half[0].colour, kGrey);
  EXPECT_EQ(half[1].colour, rising[1].colour);
  EXPECT_EQ(draw(kNone, kNone)[1].colour, kGrey);
}

TEST(MatrixPlot, FramesTheCellsThatAreMarkedAndWritesTheirValues) {
  const std::string svg = svg_of(viz::matrix_figure({{"upper", "lower"},
                                                     {"first", "second"},
                                                     {1.0, -2.34, 12.3, 0.01},
                                                     {false, true, false, false},
                                                     {true, false},
                                                     "z"}));
  const auto frames = areas(svg, kFrame);
  ASSERT_EQ(frames.size(), 1u);
  const auto all = test::words(svg);
  for (const char* value : {"1.0", "-2.3", "12", "0"}) find_words(all, value);
  const SvgWords &value = find_words(all, "-2.3"), &upper = find_words(all, "upper"),
                 &lower = find_words(all, "lower");
  EXPECT_NEAR(value.x, frames[0].left() + 0.5 * frames[0].width(), 0.5) << "in its frame";
  EXPECT_NEAR(value.y, upper.y, 2.0) << "in the upper row";
  EXPECT_LT(upper.y, lower.y);
  EXPECT_TRUE(upper.bold);
  EXPECT_FALSE(lower.bold);
}

TEST(MatrixPlot, IsAsHighAsItsRowsNeed) {
  const auto height = [](std::size_t rows) {
    return viz::matrix_figure({std::vector<std::string>(rows, "r"), {"c"}, std::vector<double>(rows, 1.0)})
        .size.height;
  };
  EXPECT_GT(height(40), height(20) + 300);
}

TEST(RowPlot, BarsAreAsLongAsTheirValues) {
  const viz::RowPlot plot{{"one", "three", "none"}, {}, {{"value", {{"", {1.0, 3.0, kNone}}}}}};
  const auto bars = areas(svg_of(viz::row_figure(plot)), kBlue);
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_NEAR(bars[1].width() / bars[0].width(), 3.0, 0.001);
  EXPECT_NEAR(bars[0].left(), bars[1].left(), 0.02);
}

TEST(RowPlot, MarkedRowsAreBoldAndInTheSecondColour) {
  const viz::RowPlot plot{
      {"usual", "marked"}, {false, true}, {{"value", {{"", {2.0, -1.0}}}, {}, {"a", "b"}}}};
  const std::string svg = svg_of(viz::row_figure(plot));
  const auto usual = areas(svg, kBlue), marked = areas(svg, kOrange);
  ASSERT_EQ(usual.size(), 1u);
  ASSERT_EQ(marked.size(), 1u);
  EXPECT_NEAR(usual[0].width() / marked[0].width(), 2.0, 0.001);
  EXPECT_NEAR(usual[0].left(), marked[0].left() + marked[0].width(), 0.02) << "zero is where both start";
  const auto all = test::words(svg);
  EXPECT_FALSE(find_words(all, "usual").bold);
  EXPECT_TRUE(find_words(all, "marked").bold);
  EXPECT_NEAR(find_words(all, "b").y, find_words(all, "marked").y, 1.0) << "notes stand in their row";
}

TEST(RowPlot, IntervalsReachFromEndToEnd) {
  viz::RowSeries series{"", {1.0, kNone}, {{0.5, 2.0}, {kNone, 1.0}}};
  series.look = viz::RowSeries::Look::points;
  const std::string svg = svg_of(viz::row_figure({{"a", "b"}, {}, {{"value", {series}, {0.0, 1.0}}}}));
  const auto points = markers(svg, kBlue);
  const auto strokes = lines(svg, kBlue), guides = lines(svg, "150,150,150");
  ASSERT_EQ(points.size(), 1u);
  ASSERT_EQ(guides.size(), 2u);
  ASSERT_EQ(strokes.size(), 3u) << "an interval and its ends";
  const double unit = guides[1][0].first - guides[0][0].first;
  EXPECT_NEAR(points[0].first, guides[1][0].first, 0.02);
  EXPECT_NEAR(strokes[0][0].first, guides[0][0].first + 0.5 * unit, 0.02);
  EXPECT_NEAR(strokes[0][1].first, guides[0][0].first + 2.0 * unit, 0.02);
}

TEST(RowPlot, WrapsLongLabelsAndKeepsPanelsApart) {
  const std::string label = "a name that is too long to stand on one line beside its bar in the picture";
  const std::string svg =
      svg_of(viz::row_figure({{label}, {}, {{"first", {{"", {1.0}}}}, {"second", {{"", {1.0}}}}}}));
  const auto all = test::words(svg);
  std::string read;
  for (const auto& w : all)
    if (w.anchor == "end" && w.x < 800.0) read += (read.empty() ? "" : " ") + w.text;
  EXPECT_EQ(read, label);
  const auto bars = areas(svg, kBlue);
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_GT(bars[1].left(), bars[0].left() + bars[0].width());
  EXPECT_NEAR(bars[0].width(), bars[1].width(), 0.02);
}

TEST(BandPlot, BandsAreAsWideAsTheirEndsAndInterruptedWhereNothingIsKnown) {
  const auto draw = [&](double half, const std::vector<double>& middle) {
    viz::BandPlot plot{"x", "y", "difference", {"measured", {0, 1, 2, 3, 4}, {0, 3, 5, 7, 10}}, {}, {}};
    viz::Band band{"simulated", {0, 1, 2, 3, 4}, {}, {}, {}};
    for (const double y : middle)
      band.low.push_back(y - half), band.middle.push_back(y), band.high.push_back(y + half);
    plot.bands = {band};
    auto found = areas(svg_of(viz::band_figure(plot)), kBlue);
    for (const auto& area : found) EXPECT_NEAR(area.opacity, 0.27, 1e-6);
    return found;
  };
  const auto narrow = draw(1.0, {5, 5, 5, 5, 5}), wide = draw(2.0, {5, 5, 5, 5, 5}),
             parted = draw(1.0, {5, 5, kNone, 5, 5}), start = draw(1.0, {5, 5, 5, kNone, kNone});
  ASSERT_EQ(narrow.size(), 1u);
  ASSERT_EQ(wide.size(), 1u);
  EXPECT_NEAR(wide[0].area() / narrow[0].area(), 2.0, 0.001);
  ASSERT_EQ(parted.size(), 2u);
  for (const auto& part : parted) EXPECT_NEAR(part.area() / narrow[0].area(), 0.25, 0.001);
  ASSERT_EQ(start.size(), 1u);
  EXPECT_NEAR(start[0].width() / narrow[0].width(), 0.5, 0.001);
}

TEST(BandPlot, APlaceByItselfIsAPointWithABar) {
  viz::BandPlot plot{"x", "y", "difference", {"measured", {0, 1, 2}, {0, 1, 2}}, {}, {}};
  plot.bands = {{"simulated", {0, 1, 2}, {kNone, 0.5, kNone}, {kNone, 1.0, kNone}, {kNone, 1.5, kNone}}};
  const std::string svg = svg_of(viz::band_figure(plot));
  EXPECT_TRUE(areas(svg, kBlue).empty());
  EXPECT_EQ(markers(svg, kBlue).size(), 2u) << "one of them in the legend";
  ASSERT_EQ(lines(svg, kBlue).size(), 1u);
  EXPECT_NEAR(lines(svg, kBlue)[0][0].first, markers(svg, kFrame)[1].first, 0.02) << "where x is one";
}

TEST(BandPlot, TheStripHasTheSameAxisBelow) {
  viz::BandPlot plot{"x", "y", "difference", {"measured", {0, 1, 2}, {3, 4, 5}}, {}, {}};
  plot.bands = {{"simulated", {0, 1, 2}, {3, 4, 5}, {4, 5, 6}, {5, 6, 7}}};
  plot.residuals = {{"", {0, 1, 2}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  plot.error = {"", {0, 1, 2}, {-1, -1, -1}, {0, 0, 0}, {1, 1, 1}};
  const std::string svg = svg_of(viz::band_figure(plot));
  const auto bands = areas(svg, kBlue), errors = areas(svg, "120,120,120");
  ASSERT_EQ(bands.size(), 2u);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(bands[0].left(), bands[1].left(), 0.02);
  EXPECT_NEAR(bands[0].width(), bands[1].width(), 0.02);
  EXPECT_NEAR(errors[0].height(), bands[1].height(), 0.02);
  find_words(test::words(svg), "difference");
}

TEST(SeriesPlot, LogarithmicAxesLeaveOutWhatHasNoPlace) {
  const viz::Series series{"values", {1.0, 10.0, 100.0, 0.0, kNone}, {1.0, 100.0, 10000.0, 5.0, 5.0}};
  const std::string svg = svg_of(viz::series_figure(std::span(&series, 1), {"x", true}, {"y", true}));
  const auto points = markers(svg, kBlue);
  ASSERT_EQ(points.size(), 4u) << "three, and one in the legend";
  EXPECT_NEAR(points[1].first - points[0].first, points[2].first - points[1].first, 0.02);
  EXPECT_NEAR(points[1].second - points[0].second, points[2].second - points[1].second, 0.02);
  const auto all = test::words(svg);
  const auto below = std::find_if(all.begin(), all.end(),
                                  [](const SvgWords& w) { return w.text == "100" && w.anchor == "middle"; });
  ASSERT_NE(below, all.end());
  EXPECT_NEAR(below->x, points[2].first, 1.0) << "ticks at whole powers of ten";
  find_words(all, "10000");
}

TEST(SeriesPlot, BarsAreOneStandardDeviationToBothSides) {
  const viz::Series series{"values", {1.0, 2.0}, {4.0, 6.0}, {1.0, kNone}};
  const std::string svg = svg_of(viz::series_figure(std::span(&series, 1), {"x"}, {"y"}));
  const auto points = markers(svg, kBlue);
  const auto bars = lines(svg, kBlue);
  ASSERT_EQ(bars.size(), 1u);
  const double unit = (points[0].second - points[1].second) / 2.0;
  EXPECT_NEAR(bars[0][0].second, points[0].second + unit, 0.05);
  EXPECT_NEAR(bars[0][1].second, points[0].second - unit, 0.05);
}

TEST(StiffnessFigure, HasACurveForEachLabelInBothPanels) {
  const std::vector<viz::StiffnessCurve> curves = {{"gap 1", {50, 100, 200}, {300, 500, 600}, {10, 20, 30}},
                                                   {"gap 2", {50, 100, 200}, {200, 400, 500}, {5, 10, 15}}};
  const std::string svg = svg_of(viz::stiffness_figure(curves, viz::MeasuredStiffness{200, 800, 5, 30}));
  for (const char* colour : {kBlue, kRed}) {
    const auto drawn = lines(svg, colour);
    ASSERT_EQ(drawn.size(), 4u) << "a line and its sample in each panel";
    EXPECT_EQ(std::count_if(drawn.begin(), drawn.end(), [](const auto& line) { return line.size() == 3; }),
              2);
  }
  EXPECT_EQ(lines(svg, "130,130,130").size(), 6u);
}

TEST(ForceFigure, TheLineEndsWithItsLinearRange) {
  const viz::ForceBranch loading{
      "loading", {0, 1, 2, 3}, {0, 10, 20, 28}, viz::ForceBranch::Line{"fit", 10.0, 0.0, 0.0, 2.0}};
  const std::string svg = svg_of(viz::force_figure(loading, {}));
  const auto points = markers(svg, kBlue);
  const auto fit = lines(svg, kRed);
  ASSERT_EQ(points.size(), 5u);
  ASSERT_EQ(fit.size(), 2u);
  const auto& line = fit[0].front().second > fit[1].front().second ? fit[0] : fit[1];  // not the legend's
  EXPECT_NEAR(line[0].first, points[0].first, 0.02);
  EXPECT_NEAR(line[1].first, points[2].first, 0.02);
  EXPECT_NEAR(line[1].second, points[2].second, 0.02);
}

class StressStrain : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const fs::path folder = fs::temp_directory_path() / ("pendular.curve." + std::to_string(::getpid()));
    test::write_planted_run(folder, planted_);
    run_ = read_run_folder(folder);
    fs::remove_all(folder);
  }
  static inline test::PlantedRun planted_;
  static inline RunFolder run_;
};

TEST_F(StressStrain, ThePeakIsWhereTheCurveIsHighest) {
  const viz::Figure figure = viz::stress_strain_figure(std::span(&run_, 1), {800, 600});
  const std::string svg = svg_of(figure);
  const auto peak = markers(svg, kRed);
  ASSERT_FALSE(peak.empty());
  double top = 600.0;
  for (const auto& line : lines(svg, kBlue))
    if (line.size() > 2)
      for (const auto& [x, y] : line) top = std::min(top, y);
  EXPECT_NEAR(peak[0].second, top, 1.0);
  // The strain axis runs over 0.77 of the picture from 0.11; the peak is at toe + 4.4 % of 8 %.
  EXPECT_NEAR(peak[0].first / 800.0, 0.11 + 0.77 * (planted_.toe + 0.044) / 0.08, 0.001);
}

TEST_F(StressStrain, BarsStandWhereBondsBrokeAndNowhereElse) {
  const auto bars = areas(svg_of(viz::stress_strain_figure(std::span(&run_, 1))), kBars);
  ASSERT_FALSE(bars.empty());
  double counted = 0.0, least = INFINITY;
  for (const auto& bar : bars)
    if (bar.left() > 0.3 * 1600) counted += bar.height(), least = std::min(least, bar.height());
  EXPECT_NEAR(counted / least, static_cast<double>(run_.break_strain.size()),
              0.02 * static_cast<double>(run_.break_strain.size()))
      << "as high as breaks in their bin, the lowest of one";
  RunFolder intact = run_;
  intact.break_strain.clear();
  EXPECT_TRUE(areas(svg_of(viz::stress_strain_figure(std::span(&intact, 1))), kBars).empty());
}

}  // namespace
}  // namespace pendular
