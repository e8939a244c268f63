#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viz/figure.h"

namespace pendular::viz {

/// Values of all rows of a row plot. What is not finite is left out.
struct RowSeries {
  enum class Look { bars, points };
  std::string label;  ///< in the legend; empty: not there
  std::vector<double> values;
  std::vector<std::pair<double, double>> intervals = {};  ///< ends of error bars; empty: none
  Look look = Look::bars;
};

/// One of the plots side by side.
struct RowPanel {
  std::string title;  ///< of the axis below
  std::vector<RowSeries> series;
  std::vector<double> guides = {};      ///< values at dashed lines across all rows
  std::vector<std::string> notes = {};  ///< at the right end of each row; empty: none
  double low = 0.0, high = 0.0;         ///< the axis holds at least this range, and all values
};

/// Horizontal bars or points with error bars, a row for each label, the first on top.
struct RowPlot {
  std::vector<std::string> labels;
  std::vector<bool> marked = {};  ///< rows in bold type and in the second colour; empty: none
  std::vector<RowPanel> panels;   ///< at most three
};

/// As high as its rows need. At least one row and one panel.
Figure row_figure(const RowPlot& plot);

}  // namespace pendular::viz
