#pragma once

#include <string>
#include <vector>

#include "diagnosis_report/table.h"
#include "viz/image.h"

namespace pendular::diagnosis_report {

/// A figure, and the numbers behind it: NAME.png and NAME.csv, and further tables under their own names.
struct Drawn {
  viz::Image image;
  std::string caption;
  Table data;  ///< its name is the figure's
  std::vector<Table> more = {};
};

}  // namespace pendular::diagnosis_report
