#pragma once

// Text, colour bar and length scale of the viz folder's pictures. Internal: knows VTK.

#include <vtkRenderer.h>

#include <string>
#include <vector>

#include "viz/canvas.h"
#include "viz/colours.h"

namespace pendular::viz {

enum class Align { left, centre };

/// Positions are shares of the picture's width and height from the lower left. `size` in pixels of a picture
/// 1200 pixels high.
struct TextStyle {
  double size = 32.0;
  bool bold = false;
  Align align = Align::left;
  double angle = 0.0;  ///< anticlockwise, degrees
};
void add_text(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double x, double y,
              const TextStyle& style = {});

/// A vertical bar at the right of the picture, with its quantity and unit above and round labels beside it.
void add_colour_bar(vtkRenderer* renderer, const Canvas& canvas, const std::string& title, Range range,
                    vtkScalarsToColors* map);

/// A horizontal bar `share` of the picture's width long, with its length in words above, at the lower right.
void add_length_scale(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double share);

}  // namespace pendular::viz
