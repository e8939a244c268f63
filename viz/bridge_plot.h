#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viz/figure.h"

namespace pendular::viz {

/// Stiffness of bridges over their diameter, one curve per gap (or whatever the label says).
struct StiffnessCurve {
  std::string label;
  std::vector<double> diameter_um, normal, tangential;  ///< µm, N/m; rising diameters
};

/// Range of measured values, N/m, drawn as two lines across the plot.
struct MeasuredStiffness {
  double normal_low, normal_high, tangential_low, tangential_high;
};

/// Two plots side by side as in Fig. 2(e,f) of Hemmerle et al. 2021: kn and kt over the bridge diameter. At
/// least one curve of at least two points.
Figure stiffness_figure(std::span<const StiffnessCurve> curves,
                        const std::optional<MeasuredStiffness>& measured = {},
                        PictureSize size = {1800, 900});

}  // namespace pendular::viz
