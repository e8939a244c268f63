#pragma once

// Off-screen window of the viz folder. Internal: knows VTK.

#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include "viz/display.h"
#include "viz/image.h"

namespace pendular::viz {

/// An off-screen window that draws at twice the picture's resolution and averages 2 × 2 pixels: smooth edges
/// without depending on what antialiasing the machine's OpenGL offers. Sizes given to VTK in pixels (text,
/// line widths) go through scaled().
class Canvas {
 public:
  /// `zoom`: the picture's pixels per unit of scaled(); 0: its height over 1200.
  Canvas(const Display& display, PictureSize size, double zoom = 0.0);

  vtkRenderWindow* window() { return window_; }

  /// Window pixels for a length that is `length` pixels in a picture 1200 pixels high (of zoom 1).
  int scaled(double length) const;

  /// Draws and reads back. ComputationFailed where OpenGL draws nothing.
  Image draw();

 private:
  Display::Connection connection_;  ///< closed after the window
  PictureSize size_;
  double zoom_;
  vtkNew<vtkRenderWindow> window_;
};

}  // namespace pendular::viz
