#include "viz/matrix_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viz/chart.h"
#include "viz/colours.h"
#include "viz/labels.h"

namespace pendular::viz {
namespace {

// Pixels of the picture.
constexpr int kWidth = 1600;
constexpr double kMargin = 24.0, kBarRoom = 210.0, kTitleRoom = 84.0, kLeastBar = 260.0;
constexpr double kRowType = 24.0, kTallestCell = 52.0, kShortestCell = 34.0, kWidestCell = 130.0;
constexpr double kValueType = 22.0,
                 kValueRoom = 52.0;  // width of a cell from which its value is written into it
constexpr std::size_t kLongestLabel = 44;
constexpr Colour kNothing = {232, 232, 232}, kFrame = {20, 20, 20}, kInk = {13, 13, 13},
                 kWhite = {255, 255, 255};
constexpr double kFrameWidth = 3.0, kGap = 1.0;  // a cell is smaller than its place by this on each side

/// Where the cells are, in pixels from the lower left.
struct Layout {
  double left, bottom, cell_width, cell_height, column_type;
  int height;
};

std::vector<std::string> short_labels(const std::vector<std::string>& labels) {
  std::vector<std::string> out;
  for (const std::string& label : labels) out.push_back(shortened(label, kLongestLabel));
  return out;
}

Layout layout_of(const std::vector<std::string>& rows, const std::vector<std::string>& columns) {
  const auto m = static_cast<double>(rows.size()), n = static_cast<double>(columns.size());
  Layout at{};
  at.left = kMargin + label_width(rows, kRowType) + 16.0;
  at.cell_width = std::min(kWidestCell, (kWidth - at.left - kBarRoom) / n);
  at.cell_height = std::clamp(900.0 / m, kShortestCell, kTallestCell);
  at.column_type = std::min(kRowType, 0.85 * at.cell_width);
  at.bottom = kMargin + label_width(columns, at.column_type) + 16.0;
  const double cells = std::max(m * at.cell_height, kLeastBar - at.bottom + kMargin);
  at.height = static_cast<int>(std::lround(at.bottom + cells + kTitleRoom + kMargin));
  return at;
}

double end_of_scale(const Matrix& matrix) {
  double end = matrix.limit;
  if (end <= 0.0)
    for (const double v : matrix.values)
      if (std::isfinite(v)) end = std::max(end, std::fabs(v));
  return end > 0.0 ? end : 1.0;
}

/// As short as a cell needs.
std::string value_label(double value) {
  if (std::fabs(value) < 0.05) return "0";
  return std::fabs(value) < 9.95 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
}

/// A cell in rows and columns from the upper left corner, smaller by so many pixels on each side.
Rectangle cell(std::size_t row, std::size_t column, const Layout& at, double inset) {
  const auto x = static_cast<double>(column), y = static_cast<double>(row);
  const double dx = inset / at.cell_width, dy = inset / at.cell_height;
  return {x + dx, -(y + 1.0 - dy), x + 1.0 - dx, -(y + dy)};
}

void add_cells(Chart& chart, const Matrix& matrix, const Layout& at, double end) {
  std::vector<Rectangle> known, unknown, frames;
  std::vector<double> values;
  for (std::size_t k = 0; k < matrix.values.size(); ++k) {
    const std::size_t row = k / matrix.columns.size(), column = k % matrix.columns.size();
    const bool framed = !matrix.framed.empty() && matrix.framed[k];
    if (framed) frames.push_back(cell(row, column, at, 0.0));
    const Rectangle inner = cell(row, column, at, framed ? kFrameWidth : kGap);
    if (!std::isfinite(matrix.values[k])) {
      unknown.push_back(inner);
      continue;
    }
    known.push_back(inner);
    values.push_back(std::clamp(matrix.values[k], -end, end));
  }
  chart.add_boxes(frames, kFrame);
  chart.add_boxes(unknown, kNothing);
  chart.add_coloured_boxes(known, values);
}

void add_values(Chart& chart, const Matrix& matrix, double end) {
  for (std::size_t k = 0; k < matrix.values.size(); ++k) {
    const double value = matrix.values[k];
    if (!std::isfinite(value)) continue;
    const std::size_t row = k / matrix.columns.size(), column = k % matrix.columns.size();
    chart.add_words(value_label(value), static_cast<double>(column) + 0.5, -(static_cast<double>(row) + 0.5),
                    kValueType, std::fabs(value) > 0.6 * end ? kWhite : kInk);
  }
}

ColourBar bar_of(const Matrix& matrix, const Layout& at, double end) {
  const double left = at.left + at.cell_width * static_cast<double>(matrix.columns.size()) + 40.0,
               top = at.height - kMargin - kTitleRoom, bottom = std::min(at.bottom, top - kLeastBar);
  ColourBar bar{{left / kWidth, bottom / at.height, 30.0 / kWidth, (top - bottom) / at.height},
                matrix.about_zero ? -end : 0.0,
                end,
                {}};
  const auto byte = [](double share) { return static_cast<unsigned char>(std::lround(255.0 * share)); };
  for (const auto& [r, g, b] : colours_of(matrix.about_zero ? ColourMap::signed_values : ColourMap::alarm))
    bar.colours.push_back({byte(r), byte(g), byte(b)});
  return bar;
}

void write_labels(Sheet& sheet, const Layout& at, const Matrix& matrix, const std::vector<std::string>& rows,
                  const std::vector<std::string>& columns) {
  for (std::size_t row = 0; row < rows.size(); ++row)
    sheet.write(rows[row], (at.left - 12.0) / kWidth,
                (at.bottom + (static_cast<double>(rows.size() - 1 - row) + 0.5) * at.cell_height) / at.height,
                {.size = kRowType,
                 .bold = !matrix.marked_rows.empty() && matrix.marked_rows[row],
                 .align = Align::right});
  for (std::size_t column = 0; column < columns.size(); ++column)
    sheet.write(columns[column], (at.left + (static_cast<double>(column) + 0.5) * at.cell_width) / kWidth,
                (at.bottom - 12.0) / at.height, {.size = at.column_type, .align = Align::right, .angle = 90});
}

}  // namespace

Figure matrix_figure(const Matrix& matrix) {
  const auto rows = short_labels(matrix.rows), columns = short_labels(matrix.columns);
  const Layout at = layout_of(rows, columns);
  const auto m = static_cast<double>(rows.size()), n = static_cast<double>(columns.size());
  const double end = end_of_scale(matrix);
  const ColourBar bar = bar_of(matrix, at, end);
  Sheet sheet({kWidth, at.height}, 1.0);
  Chart chart(
      {at.left / kWidth, at.bottom / at.height, n * at.cell_width / kWidth, m * at.cell_height / at.height},
      {0.0, n, 0}, {-m, 0.0, 0});
  chart.hide_axes();
  chart.set_colour_bar(bar);
  add_cells(chart, matrix, at, end);
  if (at.cell_width >= kValueRoom) add_values(chart, matrix, end);
  sheet.add(chart);
  write_labels(sheet, at, matrix, rows, columns);
  sheet.write(matrix.quantity, bar.area.left - 20.0 / kWidth,
              bar.area.bottom + bar.area.height + 0.7 * kTitleRoom / at.height, {.size = kRowType + 2.0});
  return sheet.figure();
}

}  // namespace pendular::viz
