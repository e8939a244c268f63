#pragma once

#include <string>
#include <vector>

#include "viz/figure.h"

namespace pendular::viz {

/// A table of numbers to be seen as colours.
struct Matrix {
  std::vector<std::string> rows, columns;
  std::vector<double> values;          ///< row by row; NaN where there is none
  std::vector<bool> framed = {};       ///< cells with a frame, row by row; empty: none
  std::vector<bool> marked_rows = {};  ///< rows named in bold type; empty: none
  std::string quantity = {};           ///< over the colour bar: a few characters
  bool about_zero = true;              ///< colours go both ways from zero; else from zero upwards
  double limit = 0.0;                  ///< value at the end of the colour bar; 0: the largest one
};

/// A cell per value, darker the farther it is from zero and with the value in it where there is room; grey
/// where there is none; a colour bar at the right. As high as its rows need. At least one row and column.
Figure matrix_figure(const Matrix& matrix);

}  // namespace pendular::viz
