#pragma once

#include <span>
#include <string>
#include <vector>

#include "viz/figure.h"

namespace pendular::viz {

/// One kind of values in a plot. Values that are not finite are left out.
struct Series {
  enum class Look { points, line, dashes };
  std::string label;
  std::vector<double> x, y;
  std::vector<double> sd = {};  ///< half lengths of error bars; empty: none
  Look look = Look::points;
};

struct SeriesAxis {
  std::string title;
  bool logarithmic = false;  ///< then only positive values are shown
};

/// Series over one pair of axes that hold all of them; linear axes start at zero where all values are
/// positive. At least one series with a value that can be shown.
Figure series_figure(std::span<const Series> series, const SeriesAxis& x, const SeriesAxis& y,
                     PictureSize size = {1200, 900});

}  // namespace pendular::viz
