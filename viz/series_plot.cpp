#include "viz/series_plot.h"

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

bool shown(double value, const SeriesAxis& axis) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0.0);
}

/// Of the logarithms where the axis is logarithmic.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void hold(double v, const SeriesAxis& axis) {
    if (!shown(v, axis)) return;
    const double place = axis.logarithmic ? std::log10(v) : v;
    low = std::min(low, place), high = std::max(high, place);
  }
};

/// With room at both ends, and above for the legend where `room_above` is more.
Axis axis_of(Extent extent, const SeriesAxis& axis, double room_above) {
  const bool from_zero = !axis.logarithmic && extent.low >= 0.0;
  if (from_zero) extent.low = 0.0;
  const double length = extent.high > extent.low ? extent.high - extent.low : 1.0;
  if (!from_zero) extent.low -= 0.06 * length;
  extent.high += room_above * length;
  if (!axis.logarithmic) return {extent.low, extent.high};
  return {std::pow(10.0, extent.low), std::pow(10.0, extent.high), 6, true};
}

void add_series(Chart& chart, const Series& series, const SeriesAxis& x_axis, const SeriesAxis& y_axis,
                Colour colour, const Sheet& sheet) {
  Points points;
  std::vector<Segment> bars;
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    const double x = series.x[k], y = series.y[k];
    if (!shown(x, x_axis) || !shown(y, y_axis)) continue;
    points.emplace_back(x, y);
    if (!series.sd.empty() && shown(y - series.sd[k], y_axis) && shown(y + series.sd[k], y_axis))
      bars.push_back({{x, y - series.sd[k]}, {x, y + series.sd[k]}});
  }
  chart.add_segments(bars, {colour, sheet.scaled(3)});
  if (series.look == Series::Look::points)
    chart.add_points(points, colour, sheet.scaled(20), series.label);
  else
    chart.add_line(points, {colour, sheet.scaled(4), series.look == Series::Look::dashes}, series.label);
}

}  // namespace

Figure series_figure(std::span<const Series> series, const SeriesAxis& x, const SeriesAxis& y,
                     PictureSize size) {
  Extent across, up;
  for (const Series& one : series) {
    for (const double value : one.x) across.hold(value, x);
    for (const double value : one.y) up.hold(value, y);
  }
  constexpr double kLineOfLegend = 0.06;  // share of the chart's height
  Sheet sheet(size);
  Chart chart(kArea, axis_of(across, x, 0.06),
              axis_of(up, y, 0.1 + kLineOfLegend * static_cast<double>(series.size())));
  for (std::size_t k = 0; k < series.size(); ++k)
    add_series(chart, series[k], x, y, kColours[k % kColours.size()], sheet);
  sheet.add(chart);
  sheet.write(x.title, kArea.middle_x(), 0.042);
  sheet.write_upright(y.title, 0.032, kArea.middle_y());
  return sheet.figure();
}

}  // namespace pendular::viz
