#pragma once

namespace pendular::viz {

enum class Align { left, centre, right };

/// Positions are shares of the picture's width and height from the lower left. `size` in pixels of a picture
/// 1200 pixels high.
struct TextStyle {
  double size = 32.0;
  bool bold = false;
  Align align = Align::left;
  double angle = 0.0;  ///< anticlockwise, degrees
  bool white = false;  ///< on dark ground
};

}  // namespace pendular::viz
