#include "micromechanics/bridge_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pendular::micromechanics {
namespace {

double cap_height(double sphere, double r) {
  return r * r / (sphere + std::sqrt(sphere * sphere - r * r));
}

double cap_slope(double sphere, double r) {
  return r / std::sqrt(sphere * sphere - r * r);
}

/// Distances of the layers from the rim over the width of their zone, falling, the zone's own bound first.
std::vector<double> layer_bounds(const BridgeResolution& resolution) {
  std::vector<double> bounds = {1.0};
  for (int k = 0; k < resolution.rim_layers; ++k) bounds.push_back(bounds.back() * resolution.rim_ratio);
  return bounds;
}

std::vector<double> radial_bounds(const BridgeGrid& grid, const BridgeResolution& resolution) {
  const double height = grid.gap + cap_height(grid.radius_lower, 1.0) + cap_height(grid.radius_upper, 1.0);
  const double zone = std::min(0.5 * resolution.rim_reach * height, 0.5);
  const double inside = 1.0 - zone;
  const double axis = std::sqrt(2.0 * grid.gap * grid.radius_lower * grid.radius_upper /
                                (grid.radius_lower + grid.radius_upper));
  const double reach = std::asinh(inside / axis);
  const int steps = std::max(1, static_cast<int>(std::ceil(reach / resolution.axis_stride)));
  std::vector<double> bounds;
  for (int k = 0; k < steps; ++k) bounds.push_back(inside * std::sinh(reach * k / steps) / std::sinh(reach));
  for (double share : layer_bounds(resolution)) bounds.push_back(1.0 - zone * share);
  bounds.push_back(1.0);
  return bounds;
}

std::vector<double> axial_bounds(bool half, const BridgeResolution& resolution) {
  const auto layers = layer_bounds(resolution);
  std::vector<double> bounds = {0.0};
  if (half) {
    for (double share : layers) bounds.push_back(1.0 - share);
    bounds.erase(bounds.begin());
  } else {
    for (auto share = layers.rbegin(); share != layers.rend(); ++share) bounds.push_back(0.5 * *share);
    for (std::size_t k = 1; k < layers.size(); ++k) bounds.push_back(1.0 - 0.5 * layers[k]);
  }
  bounds.push_back(1.0);
  return bounds;
}

Eigen::VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

BridgeGrid::Section BridgeGrid::section(double r) const {
  Section s{0.0, 0.5 * gap + cap_height(radius_upper, r), 0.0, cap_slope(radius_upper, r)};
  if (!half) {
    s.lower = -0.5 * gap - cap_height(radius_lower, r);
    s.lower_slope = -cap_slope(radius_lower, r);
  }
  return s;
}

BridgeGrid bridge_grid(const BridgeBody& body, const BridgeResolution& resolution) {
  BridgeGrid grid;
  grid.order = resolution.order;
  grid.half = body.diameter_i == body.diameter_j;
  grid.gap = 2.0 * body.gap / body.neck_diameter;
  grid.radius_lower = body.diameter_i / body.neck_diameter;
  grid.radius_upper = body.diameter_j / body.neck_diameter;
  grid.radial = to_vector(radial_bounds(grid, resolution));
  grid.axial = to_vector(axial_bounds(grid.half, resolution));
  return grid;
}

}  // namespace pendular::micromechanics
