#pragma once

#include <array>
#include <span>
#include <vector>

namespace pendular::viz {

struct Colour {
  unsigned char r, g, b;
};

struct Range {
  double low = 0.0, high = 1.0;
};

/// Between two quantiles of the finite values, so that a few outliers do not take the colours; widened where
/// it would be empty.
Range robust_range(std::span<const double> values, double lower = 0.02, double upper = 0.98);

/// CIELAB lightness changes evenly from end to end, so that equal steps of the value look equal; in the first
/// two in grey print as well. `rising` goes from dark to light; `alarm` from pale grey to dark red, for what
/// is zero nearly everywhere; `signed_values` from blue over nearly white to red, for ranges about zero.
enum class ColourMap { rising, alarm, signed_values };

/// Red, green and blue from 0 to 1 at evenly spaced places from the low end to the high one; between them by
/// straight lines.
std::vector<std::array<double, 3>> colours_of(ColourMap map);

}  // namespace pendular::viz
