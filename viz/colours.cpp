#include "viz/colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pendular::viz {
namespace {

struct Lab {
  double l, a, b;
};

/// CIELAB (D65) to sRGB, clipped to what a screen shows.
std::array<double, 3> to_rgb(const Lab& lab) {
  const auto inverse = [](double t) {
    return t > 6.0 / 29.0 ? t * t * t : 3.0 * std::pow(6.0 / 29.0, 2) * (t - 4.0 / 29.0);
  };
  const double fy = (lab.l + 16.0) / 116.0;
  const double x = 0.95047 * inverse(fy + lab.a / 500.0), y = inverse(fy),
               z = 1.08883 * inverse(fy - lab.b / 200.0);
  const std::array<double, 3> linear = {3.2406 * x - 1.5372 * y - 0.4986 * z,
                                        -0.9689 * x + 1.8758 * y + 0.0415 * z,
                                        0.0557 * x - 0.2040 * y + 1.0570 * z};
  std::array<double, 3> rgb;
  for (std::size_t k = 0; k < 3; ++k) {
    const double v = std::clamp(linear[k], 0.0, 1.0);
    rgb[k] = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
  }
  return rgb;
}

/// Stations of equal lightness step; chroma and hue chosen to stay inside what sRGB shows.
std::vector<Lab> stations(ColourMap map) {
  if (map == ColourMap::rising)
    return {{22, 33, -45}, {39, 5, -38}, {56, -28, -8}, {73, -38, 38}, {90, -8, 78}};
  if (map == ColourMap::signed_values)
    return {{38, 12, -48}, {67, -6, -32}, {96, 0, 0}, {67, 36, 30}, {38, 56, 36}};
  return {{88, 0, 4}, {74, 14, 34}, {60, 44, 46}, {46, 58, 48}, {32, 50, 38}};
}

}  // namespace

Range robust_range(std::span<const double> values, double lower, double upper) {
  std::vector<double> finite;
  for (double v : values)
    if (std::isfinite(v)) finite.push_back(v);
  if (finite.empty()) return {};
  std::sort(finite.begin(), finite.end());
  const auto at = [&](double share) {
    return finite[static_cast<std::size_t>(share * static_cast<double>(finite.size() - 1))];
  };
  Range range{at(lower), at(upper)};
  if (range.high > range.low) return range;
  return finite.back() > range.low ? Range{range.low, finite.back()} : Range{range.low, range.low + 1.0};
}

std::vector<std::array<double, 3>> colours_of(ColourMap map) {
  const auto knots = stations(map);
  constexpr int kSteps = 64;
  std::vector<std::array<double, 3>> colours;
  for (int k = 0; k <= kSteps; ++k) {
    const double u = static_cast<double>(k) / kSteps * static_cast<double>(knots.size() - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(u), knots.size() - 2);
    const double w = u - static_cast<double>(first);
    const Lab &p = knots[first], &q = knots[first + 1];
    colours.push_back(to_rgb({p.l + w * (q.l - p.l), p.a + w * (q.a - p.a), p.b + w * (q.b - p.b)}));
  }
  return colours;
}

}  // namespace pendular::viz
