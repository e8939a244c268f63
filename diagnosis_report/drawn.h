#pragma once

#include <string>
#include <variant>
#include <vector>

#include "diagnosis_report/table.h"
#include "viz/figure.h"
#include "viz/image.h"

namespace pendular::diagnosis_report {

/// A figure, and the numbers behind it: a chart as NAME.png, .pdf and .svg, another picture as NAME.png;
/// NAME.csv, and further tables under their own names.
struct Drawn {
  std::variant<viz::Figure, viz::Image> picture;
  std::string caption;
  Table data;  ///< its name is the figure's
  std::vector<Table> more = {};
};

}  // namespace pendular::diagnosis_report
