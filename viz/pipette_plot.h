#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viz/figure.h"

namespace pendular::viz {

/// Points of one direction of a micropipette test, and the line through its linear range where there is one.
struct ForceBranch {
  std::string label;
  std::vector<double> displacement_um, force_un;  ///< µm, µN
  struct Line {
    std::string label;
    double slope, intercept;   ///< µN/µm, µN
    double first_um, last_um;  ///< of the linear range
  };
  std::optional<Line> line;
};

/// Force over displacement: loading, unloading, the fitted lines over their linear ranges. Loading has
/// points.
Figure force_figure(const ForceBranch& loading, const ForceBranch& unloading, PictureSize size = {});

}  // namespace pendular::viz
