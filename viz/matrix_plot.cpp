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
constexpr double kValueRoom = 52.0;  // width of a cell from which its value is written into it
constexpr std::size_t kLongestLabel = 44;
constexpr Rgb kNothing = {232, 232, 232}, kGrid = {255, 255, 255}, kFrame = {20, 20, 20};

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

/// Draws cells and labels, in pixels.
class Drawing {
 public:
  Drawing(ChartSheet& sheet, const Layout& at) : sheet_(sheet), at_(at) {}

  /// A cell, `inset` pixels smaller on each side.
  Box cell(std::size_t row, std::size_t column, std::size_t rows, double inset) const {
    const double left = at_.left + static_cast<double>(column) * at_.cell_width,
                 bottom = at_.bottom + static_cast<double>(rows - 1 - row) * at_.cell_height;
    return {(left + inset) / kWidth, (bottom + inset) / at_.height, (left + at_.cell_width - inset) / kWidth,
            (bottom + at_.cell_height - inset) / at_.height};
  }
  void write(const std::string& words, double x, double y, const TextStyle& style) {
    sheet_.write(words, x / kWidth, y / at_.height, style);
  }

 private:
  ChartSheet& sheet_;
  const Layout& at_;
};

void draw_cells(ChartSheet& sheet, Drawing& drawing, const Layout& at, const Matrix& matrix,
                vtkScalarsToColors* map, double end) {
  const std::size_t m = matrix.rows.size(), n = matrix.columns.size();
  std::vector<Box> boxes;
  std::vector<Rgb> rgb;
  const auto fill = [&](const Box& box, const Rgb& colour) { boxes.push_back(box), rgb.push_back(colour); };
  for (std::size_t k = 0; k < matrix.values.size(); ++k) {
    const std::size_t row = k / n, column = k % n;
    const double value = matrix.values[k];
    const bool framed = !matrix.framed.empty() && matrix.framed[k];
    fill(drawing.cell(row, column, m, 0.0), framed ? kFrame : kGrid);
    Rgb colour = kNothing;
    if (std::isfinite(value)) {
      const unsigned char* c = map->MapValue(std::clamp(value, -end, end));
      colour = {c[0], c[1], c[2]};
    }
    fill(drawing.cell(row, column, m, framed ? 3.0 : 1.0), colour);
  }
  add_boxes(sheet.renderer(), boxes, rgb);
  if (at.cell_width < kValueRoom) return;
  for (std::size_t k = 0; k < matrix.values.size(); ++k) {
    const double value = matrix.values[k];
    if (!std::isfinite(value)) continue;
    const bool dark = std::fabs(value) > 0.6 * end;
    drawing.write(value_label(value), at.left + (static_cast<double>(k % n) + 0.5) * at.cell_width,
                  at.bottom + (static_cast<double>(m - 1 - k / n) + 0.5) * at.cell_height,
                  {.size = 22, .align = Align::centre, .white = dark});
  }
}

void draw_labels(Drawing& drawing, const Layout& at, const Matrix& matrix,
                 const std::vector<std::string>& rows, const std::vector<std::string>& columns) {
  for (std::size_t row = 0; row < rows.size(); ++row)
    drawing.write(rows[row], at.left - 12.0,
                  at.bottom + (static_cast<double>(rows.size() - 1 - row) + 0.5) * at.cell_height,
                  {.size = kRowType,
                   .bold = !matrix.marked_rows.empty() && matrix.marked_rows[row],
                   .align = Align::right});
  for (std::size_t column = 0; column < columns.size(); ++column)
    drawing.write(columns[column], at.left + (static_cast<double>(column) + 0.5) * at.cell_width,
                  at.bottom - 12.0, {.size = at.column_type, .align = Align::right, .angle = 90});
}

}  // namespace

Image draw_matrix(const Display& display, const Matrix& matrix) {
  const auto rows = short_labels(matrix.rows), columns = short_labels(matrix.columns);
  const Layout at = layout_of(rows, columns);
  ChartSheet sheet(display, {kWidth, at.height}, 1.0);
  Drawing drawing(sheet, at);
  const double end = end_of_scale(matrix);
  const Range range{matrix.about_zero ? -end : 0.0, end};
  const auto map = colours(matrix.about_zero ? ColourMap::signed_values : ColourMap::alarm, range);
  draw_cells(sheet, drawing, at, matrix, map, end);
  draw_labels(drawing, at, matrix, rows, columns);
  const double right = at.left + at.cell_width * static_cast<double>(columns.size()) + 40.0,
               top = at.height - kMargin - kTitleRoom, bottom = std::min(at.bottom, top - kLeastBar);
  add_colour_bar(sheet.renderer(), sheet.canvas(), "", range, map,
                 {right / kWidth, bottom / at.height, (right + 30.0) / kWidth, top / at.height});
  drawing.write(matrix.quantity, right - 20.0, top + 0.7 * kTitleRoom, {.size = kRowType + 2.0});
  return sheet.draw();
}

}  // namespace pendular::viz
