#pragma once

#include <vector>

#include "pipette/grey_image.h"

namespace pendular::pipette {

/// Interpolating cubic B-spline of an image's window (Unser, Aldroubi & Eden 1993, IEEE Trans. Signal
/// Process. 41, 821): passes through every pixel, twice continuously differentiable, mirrored at the window's
/// rim. Its error against fractional position is far below that of bilinear or cubic convolution, which is
/// what makes trackers prefer whole or half pixels (peak locking).
class SplineWindow {
 public:
  /// The window is cut to the image. Before, the grey values are smoothed by a Gaussian of this sd in pixels;
  /// 0: not at all.
  SplineWindow(const GreyImage& image, const Region& window, double smoothing = 0.0);

  struct Value {
    double value, dx, dy;
  };
  /// Value and gradient (per pixel) at a point of the image; outside the window, mirrored.
  Value at(const Point& point) const;

  /// Values at (x + shift.x, y + shift.y) for whole pixels (x, y): all share the same sixteen weights.
  std::vector<double> shifted(const std::vector<Eigen::Vector2i>& pixels, const Point& shift) const;

 private:
  int x0_, y0_, width_, height_;
  std::vector<double> coefficients_;
  double coefficient(int x, int y) const;
};

}  // namespace pendular::pipette
