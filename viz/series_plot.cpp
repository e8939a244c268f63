#include "viz/series_plot.h"

#include <vtkAxis.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

constexpr std::array<Colour, 8> kColours = {{{31, 90, 165},
                                             {190, 40, 30},
                                             {20, 130, 80},
                                             {150, 90, 20},
                                             {110, 60, 150},
                                             {30, 30, 30},
                                             {0, 150, 170},
                                             {120, 120, 120}}};
constexpr Area kArea{0.13, 0.125, 0.83, 0.845};

/// A value's place on an axis; NaN where it has none.
double place(double value, const SeriesAxis& axis) {
  if (!axis.logarithmic) return value;
  return value > 0.0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void hold(double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
};

/// With room at both ends, and above for the legend where `room_above` is more.
Extent widened(Extent extent, const SeriesAxis& axis, double room_above) {
  const bool from_zero = !axis.logarithmic && extent.low >= 0.0;
  if (from_zero) extent.low = 0.0;
  const double length = extent.high > extent.low ? extent.high - extent.low : 1.0;
  if (!from_zero) extent.low -= 0.06 * length;
  extent.high += room_above * length;
  return extent;
}

/// An upright bar of one standard deviation to both sides, as far as it can be shown.
void add_error_bar(vtkChartXY* chart, double x, double value, double sd, const SeriesAxis& axis,
                   Colour colour, const Canvas& canvas) {
  const double low = place(value - sd, axis), high = place(value + sd, axis);
  if (!std::isfinite(low) || !std::isfinite(high)) return;
  add_plot(chart, vtkChart::LINE, {{x, low}, {x, high}}, "", colour, canvas.scaled(3));
}

void add_series(vtkChartXY* chart, const Series& series, const SeriesAxis& x_axis, const SeriesAxis& y_axis,
                Colour colour, const Canvas& canvas) {
  Points points;
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    const double x = place(series.x[k], x_axis), y = place(series.y[k], y_axis);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    points.emplace_back(x, y);
    if (!series.sd.empty()) add_error_bar(chart, x, series.y[k], series.sd[k], y_axis, colour, canvas);
  }
  if (points.empty()) return;
  if (series.look != Series::Look::points) {
    vtkPlot* line = add_plot(chart, vtkChart::LINE, points, series.label, colour, canvas.scaled(4));
    if (series.look == Series::Look::dashes) line->GetPen()->SetLineType(vtkPen::DASH_LINE);
    return;
  }
  auto* plot = vtkPlotPoints::SafeDownCast(
      add_plot(chart, vtkChart::POINTS, points, series.label, colour, canvas.scaled(3)));
  plot->SetMarkerStyle(vtkPlotPoints::CIRCLE);
  plot->SetMarkerSize(static_cast<float>(canvas.scaled(20)));
}

void fix(vtkAxis* axis, const Extent& extent, const SeriesAxis& kind, const Canvas& canvas) {
  if (kind.logarithmic)
    set_log_axis(axis, extent.low, extent.high, canvas);
  else
    set_axis(axis, extent.low, extent.high, canvas);
}

}  // namespace

Image draw_series(const Display& display, std::span<const Series> series, const SeriesAxis& x,
                  const SeriesAxis& y, PictureSize size) {
  ChartSheet sheet(display, size);
  const Canvas& canvas = sheet.canvas();
  vtkChartXY* chart = sheet.add_chart(kArea);
  Extent across, up;
  for (std::size_t k = 0; k < series.size(); ++k) {
    add_series(chart, series[k], x, y, kColours[k % kColours.size()], canvas);
    for (double value : series[k].x) across.hold(place(value, x));
    for (double value : series[k].y) up.hold(place(value, y));
  }
  constexpr double kLineOfLegend = 0.06;  // share of the chart's height
  fix(chart->GetAxis(vtkAxis::BOTTOM), widened(across, x, 0.06), x, canvas);
  fix(chart->GetAxis(vtkAxis::LEFT), widened(up, y, 0.1 + kLineOfLegend * static_cast<double>(series.size())),
      y, canvas);
  sheet.write(x.title, kArea.middle_x(), 0.042);
  sheet.write_upright(y.title, 0.032, kArea.middle_y());
  return sheet.draw();
}

}  // namespace pendular::viz
