#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace pendular::pipette {

/// A position or displacement in the image, pixels: x to the right, y down, the centre of the upper left
/// pixel at (0, 0).
using Point = Eigen::Vector2d;

/// Grey values over full scale (0 black, 1 white), rows from the top.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<double> values;

  GreyImage() = default;
  GreyImage(int w, int h, double value = 0.0)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  double& at(int x, int y) { return values[index(x, y)]; }
  double at(int x, int y) const { return values[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// A rectangle of whole pixels; (x, y) is its upper left one.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;

  Point centre() const { return {x + 0.5 * (width - 1), y + 0.5 * (height - 1)}; }
  bool within(const GreyImage& image) const {
    return x >= 0 && y >= 0 && width > 0 && height > 0 && width <= image.width - x &&
           height <= image.height - y;
  }
};

}  // namespace pendular::pipette
