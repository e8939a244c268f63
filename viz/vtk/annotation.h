#pragma once

// Text, colour bar and length scale of the viz folder's pictures. Internal: knows VTK.

#include <vtkColorTransferFunction.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <string>
#include <vector>

#include "viz/colours.h"
#include "viz/text_style.h"
#include "viz/vtk/canvas.h"

namespace pendular::viz {

void add_text(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double x, double y,
              const TextStyle& style = {});

/// Coloured rectangles in shares of the picture.
struct Box {
  double left, bottom, right, top;
};
using Rgb = std::array<unsigned char, 3>;
void add_boxes(vtkRenderer* renderer, const std::vector<Box>& boxes, const std::vector<Rgb>& colours);

/// The colours of a range of values; those that are no number are grey.
vtkSmartPointer<vtkColorTransferFunction> colours(ColourMap map, Range range);

/// Where a colour bar stands by itself: at the right of the picture.
inline constexpr Box kColourBar{0.845, 0.24, 0.875, 0.76};

/// A vertical bar, with its quantity and unit above and round labels beside it.
void add_colour_bar(vtkRenderer* renderer, const Canvas& canvas, const std::string& title, Range range,
                    vtkScalarsToColors* map, const Box& bar = kColourBar);

/// A horizontal bar `share` of the picture's width long, with its length in words above, at the lower right.
void add_length_scale(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double share);

}  // namespace pendular::viz
