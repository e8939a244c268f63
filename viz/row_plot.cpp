#include "viz/row_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "viz/chart.h"
#include "viz/labels.h"

namespace pendular::viz {
namespace {

// Pixels of the picture.
constexpr int kWidth = 1600;
constexpr double kMargin = 24.0, kBelow = 100.0, kLegendLine = 40.0, kRowType = 24.0, kZoom = 0.72;
constexpr double kLeastRow = 38.0, kSpareHeight = 320.0, kTallestRow = 80.0, kBetween = 60.0;
constexpr double kBarHeight = 0.7;  // of all bars of a row together, in rows
constexpr std::size_t kLongestLine = 46, kMostLines = 3;
constexpr std::array<Colour, 4> kColours = {{{31, 90, 165}, {214, 106, 20}, {110, 110, 110}, {20, 130, 80}}};
constexpr Colour kGuide{150, 150, 150}, kInk{40, 40, 40};

/// Room in pixels around the panels.
struct Layout {
  double left, above, row;
  int height;
};

std::size_t legend_lines(const RowPlot& plot) {
  std::size_t most = 0;
  for (const RowPanel& panel : plot.panels)
    most = std::max(most, static_cast<std::size_t>(
                              std::count_if(panel.series.begin(), panel.series.end(),
                                            [](const RowSeries& series) { return !series.label.empty(); })));
  return most;
}

Layout layout_of(const RowPlot& plot, const std::vector<std::string>& labels) {
  const auto n = static_cast<double>(labels.size());
  std::size_t lines = 1;
  for (const std::string& label : labels)
    lines = std::max(lines, 1 + static_cast<std::size_t>(std::count(label.begin(), label.end(), '\n')));
  Layout at{};
  at.left = kMargin + label_width(labels, kRowType) + 20.0;
  at.above = kMargin + kLegendLine * static_cast<double>(legend_lines(plot));
  at.row = std::max(std::clamp(kSpareHeight / n, kLeastRow, kTallestRow),
                    1.25 * kRowType * static_cast<double>(lines) + 10.0);
  at.height = static_cast<int>(std::lround(at.above + n * at.row + kBelow));
  return at;
}

/// The range of a panel's axis, with a little room beyond the values and more for notes.
std::pair<double, double> range_of(const RowPanel& panel, double width) {
  double low = panel.low, high = panel.high;
  const auto hold = [&](double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  };
  for (const RowSeries& series : panel.series) {
    for (const double v : series.values) hold(v);
    for (const auto& [from, to] : series.intervals) hold(from), hold(to);
  }
  if (!(high > low)) high = low + 1.0;
  const double length = high - low;
  if (low < 0.0) low -= 0.04 * length;
  high += 0.04 * length;
  const double room = std::min(0.6, (label_width(panel.notes, kRowType) + 20.0) / width);
  if (!panel.notes.empty()) high += (high - low) * room / (1.0 - room);
  return {low, high};
}

/// An interval with a stroke across at each end.
void add_interval(std::vector<Segment>& strokes, const std::pair<double, double>& interval, double y) {
  const auto [low, high] = interval;
  if (!std::isfinite(low) || !std::isfinite(high)) return;
  strokes.push_back({{low, y}, {high, y}});
  for (const double end : {low, high}) strokes.push_back({{end, y - 0.12}, {end, y + 0.12}});
}

/// Series `index` of `count` bar series in row `row`; rows count from the top, at heights -0.5, -1.5, …
double height_of(std::size_t row, std::size_t index, std::size_t count) {
  const double part = kBarHeight / static_cast<double>(count);
  return -0.5 - static_cast<double>(row) + 0.5 * kBarHeight - part * (static_cast<double>(index) + 0.5);
}

void add_bars(Chart& chart, const RowSeries& series, std::size_t index, std::size_t count,
              const std::vector<bool>& marked) {
  const double half = 0.47 * kBarHeight / static_cast<double>(count);
  std::vector<Rectangle> usual, second;
  for (std::size_t row = 0; row < series.values.size(); ++row) {
    const double value = series.values[row], y = height_of(row, index, count);
    const bool is_marked = count == 1 && !marked.empty() && marked[row];
    (is_marked ? second : usual).push_back({0.0, y - half, value, y + half});
  }
  chart.add_boxes(usual, kColours[index % kColours.size()]);
  chart.add_boxes(second, kColours[1]);
}

void add_points(Chart& chart, const RowSeries& series, std::size_t index, std::size_t count, Colour colour,
                const Sheet& sheet) {
  Points points;
  for (std::size_t row = 0; row < series.values.size(); ++row)
    points.emplace_back(series.values[row], height_of(row, index, count));
  chart.add_points(points, colour, sheet.scaled(22));
}

void add_guides(Chart& chart, const RowPanel& panel, double low, std::size_t rows, const Sheet& sheet) {
  const double bottom = -static_cast<double>(rows);
  for (const double value : panel.guides)
    chart.add_line({{value, bottom}, {value, 0.0}}, {kGuide, sheet.scaled(3), true});
  if (low < 0.0) chart.add_line({{0.0, bottom}, {0.0, 0.0}}, {kInk, sheet.scaled(2)});
}

void add_series(Chart& chart, const RowPanel& panel, const std::vector<bool>& marked, const Sheet& sheet) {
  const auto is_bar = [](const RowSeries& series) { return series.look == RowSeries::Look::bars; };
  const auto bars = static_cast<std::size_t>(std::count_if(panel.series.begin(), panel.series.end(), is_bar));
  const std::size_t points = panel.series.size() - bars;
  std::size_t bar = 0, point = 0;
  for (const RowSeries& series : panel.series) {
    const std::size_t index = is_bar(series) ? bar++ : point++, count = is_bar(series) ? bars : points;
    const Colour colour = kColours[index % kColours.size()];
    if (is_bar(series)) add_bars(chart, series, index, count, marked);
    std::vector<Segment> strokes;
    for (std::size_t row = 0; row < series.intervals.size(); ++row)
      add_interval(strokes, series.intervals[row], height_of(row, index, count));
    chart.add_segments(strokes, {is_bar(series) ? kInk : colour, sheet.scaled(4)});
    if (!is_bar(series)) add_points(chart, series, index, count, colour, sheet);
  }
}

/// Lines of a swatch and words above a panel.
void write_legend(Sheet& sheet, const RowPanel& panel, const Layout& at, double left) {
  double y = at.height - kMargin - 0.5 * kLegendLine;
  std::size_t index = 0;
  for (const RowSeries& series : panel.series) {
    const Colour colour = kColours[index++ % kColours.size()];
    if (series.label.empty()) continue;
    sheet.fill({left / kWidth, (y - 10.0) / at.height, 34.0 / kWidth, 20.0 / at.height}, colour);
    sheet.write(series.label, (left + 46.0) / kWidth, y / at.height, {.size = kRowType / kZoom});
    y -= kLegendLine;
  }
}

void add_panel(Sheet& sheet, const RowPlot& plot, const RowPanel& panel, const Layout& at, double left,
               double width) {
  const auto n = static_cast<double>(plot.labels.size());
  const Area area{left / kWidth, kBelow / at.height, width / kWidth, n * at.row / at.height};
  const auto [low, high] = range_of(panel, width);
  Chart chart(area, {low, high}, {-n, 0.0, 0});
  add_guides(chart, panel, low, plot.labels.size(), sheet);
  add_series(chart, panel, plot.marked, sheet);
  sheet.add(chart);
  write_legend(sheet, panel, at, left);
  sheet.write(panel.title, area.middle_x(), 0.32 * kBelow / at.height, {.size = 34, .align = Align::centre});
  for (std::size_t row = 0; row < panel.notes.size(); ++row)
    sheet.write(panel.notes[row], (left + width - 8.0) / kWidth,
                (kBelow + (n - 0.5 - static_cast<double>(row)) * at.row) / at.height,
                {.size = kRowType / kZoom, .align = Align::right});
}

}  // namespace

Figure row_figure(const RowPlot& plot) {
  std::vector<std::string> labels;
  for (const std::string& label : plot.labels) labels.push_back(wrapped(label, kLongestLine, kMostLines));
  const Layout at = layout_of(plot, labels);
  Sheet sheet({kWidth, at.height}, kZoom);
  const auto count = static_cast<double>(plot.panels.size());
  const double width = (kWidth - kMargin - 20.0 - at.left - (count - 1.0) * kBetween) / count;
  for (std::size_t k = 0; k < plot.panels.size(); ++k)
    add_panel(sheet, plot, plot.panels[k], at, at.left + static_cast<double>(k) * (width + kBetween), width);
  for (std::size_t row = 0; row < labels.size(); ++row)
    sheet.write(
        labels[row], (at.left - 14.0) / kWidth,
        (kBelow + (static_cast<double>(labels.size() - row) - 0.5) * at.row) / at.height,
        {.size = kRowType / kZoom, .bold = !plot.marked.empty() && plot.marked[row], .align = Align::right});
  return sheet.figure();
}

}  // namespace pendular::viz
