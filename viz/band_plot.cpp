#include "viz/band_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

constexpr std::array<Colour, 3> kColours = {{{31, 90, 165}, {214, 106, 20}, {20, 130, 80}}};
constexpr Colour kBlack{20, 20, 20}, kGrey{120, 120, 120};
constexpr Area kWhole{0.115, 0.1, 0.865, 0.88}, kMain{0.115, 0.37, 0.865, 0.61},
    kStrip{0.115, 0.1, 0.865, 0.21};
constexpr double kZoom = 0.78;
constexpr double kBandOpacity = 0.27, kLineOpacity = 0.35;
constexpr std::size_t kFewPoints = 60;  // up to which points are drawn large

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void hold(const std::vector<double>& values) {
    for (const double v : values)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  /// Takes zero in where that is near: below this share of the highest value.
  void hold_zero(double share) {
    if (low > 0.0 && low < share * high) low = 0.0;
  }
  /// With room at both ends, in shares of its length.
  Extent widened(double below, double above) const {
    if (!(high >= low)) return {0.0, 1.0};
    const double length = high > low ? high - low : std::max(1e-3, std::fabs(high));
    return {low - below * length, high + above * length};
  }
};

bool there(const Band& band, std::size_t k) {
  return std::isfinite(band.x[k]) && std::isfinite(band.low[k]) && std::isfinite(band.middle[k]) &&
         std::isfinite(band.high[k]);
}

/// The parts of a band between its interruptions, as [first, last).
std::vector<std::pair<std::size_t, std::size_t>> parts(const Band& band) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t k = 0; k < band.x.size(); ++k) {
    if (!there(band, k)) continue;
    const std::size_t first = k;
    while (k < band.x.size() && there(band, k)) ++k;
    found.emplace_back(first, k);
  }
  return found;
}

std::vector<double> part_of(const std::vector<double>& values, std::size_t first, std::size_t last) {
  return {values.begin() + static_cast<std::ptrdiff_t>(first),
          values.begin() + static_cast<std::ptrdiff_t>(last)};
}

Points points_of(const std::vector<double>& x, const std::vector<double>& y) {
  Points points;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k])) points.emplace_back(x[k], y[k]);
  return points;
}

void add_fills(Chart& chart, const Band& band, Colour colour) {
  for (const auto& [first, last] : parts(band))
    chart.add_fill(part_of(band.x, first, last), part_of(band.low, first, last),
                   part_of(band.high, first, last), colour, kBandOpacity);
}

void add_band(Chart& chart, const Band& band, Colour colour, bool named, const Sheet& sheet) {
  for (const Series& line : band.lines)
    chart.add_line(points_of(line.x, line.y), {colour, sheet.scaled(1.5), false, kLineOpacity});
  add_fills(chart, band, colour);
  bool first_part = named;
  for (const auto& [first, last] : parts(band)) {
    const auto x = part_of(band.x, first, last), middle = part_of(band.middle, first, last);
    const std::string label = first_part ? band.label : "";
    first_part = false;
    if (x.size() > 1) {
      chart.add_line(points_of(x, middle), {colour, sheet.scaled(5)}, label);
      continue;
    }
    chart.add_segments({{{x[0], band.low[first]}, {x[0], band.high[first]}}}, {colour, sheet.scaled(4)});
    chart.add_points(points_of(x, middle), colour, sheet.scaled(20), label);
  }
}

void add_measured(Chart& chart, const Series& measured, const Sheet& sheet) {
  const Points points = points_of(measured.x, measured.y);
  if (measured.look != Series::Look::points)
    return chart.add_line(points, {kBlack, sheet.scaled(4)}, measured.label);
  std::vector<Segment> bars;
  for (std::size_t k = 0; k < measured.sd.size(); ++k)
    bars.push_back(
        {{measured.x[k], measured.y[k] - measured.sd[k]}, {measured.x[k], measured.y[k] + measured.sd[k]}});
  chart.add_segments(bars, {kBlack, sheet.scaled(3)});
  chart.add_points(points, kBlack, sheet.scaled(points.size() > kFewPoints ? 7 : 18), measured.label);
}

Extent across(const BandPlot& plot) {
  Extent extent;
  extent.hold(plot.measured.x);
  for (const Band& band : plot.bands) extent.hold(band.x);
  extent.hold_zero(0.25);
  return extent.widened(0.02, 0.03);
}

/// Room above for the legend.
Extent up(const BandPlot& plot) {
  Extent extent;
  extent.hold(plot.measured.y);
  for (const Band& band : plot.bands) {
    extent.hold(band.low), extent.hold(band.high);
    for (const Series& line : band.lines) extent.hold(line.y);
  }
  extent.hold_zero(0.7);
  const double lines = 1.0 + static_cast<double>(plot.bands.size());
  return extent.widened(0.04, 0.06 + 0.085 * lines);
}

void add_strip(Sheet& sheet, const BandPlot& plot, const Extent& x) {
  Extent y;
  y.hold({0.0});
  y.hold(plot.error.low), y.hold(plot.error.high);
  for (const Band& band : plot.residuals) y.hold(band.low), y.hold(band.high);
  y = y.widened(0.08, 0.08);
  Chart chart(kStrip, {x.low, x.high}, {y.low, y.high, 4});
  add_fills(chart, plot.error, kGrey);
  for (std::size_t k = 0; k < plot.residuals.size(); ++k)
    add_band(chart, plot.residuals[k], kColours[k % kColours.size()], false, sheet);
  chart.add_line({{x.low, 0.0}, {x.high, 0.0}}, {kBlack, sheet.scaled(2.5)});
  sheet.add(chart);
  sheet.write_upright(plot.residual_title, 0.022, kStrip.middle_y());
}

}  // namespace

Figure band_figure(const BandPlot& plot, PictureSize size) {
  Sheet sheet(size, kZoom * size.width / 1600.0);
  const bool strip = !plot.residuals.empty();
  const Area area = strip ? kMain : kWhole;
  const Extent x = across(plot), y = up(plot);
  Chart chart(area, {x.low, x.high}, {y.low, y.high});
  for (std::size_t k = 0; k < plot.bands.size(); ++k)
    add_band(chart, plot.bands[k], kColours[k % kColours.size()], true, sheet);
  add_measured(chart, plot.measured, sheet);
  sheet.add(chart);
  sheet.write_upright(plot.y_title, 0.022, area.middle_y());
  sheet.write(plot.x_title, area.middle_x(), 0.03);
  if (strip) add_strip(sheet, plot, x);
  return sheet.figure();
}

}  // namespace pendular::viz
