#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "viz/display.h"
#include "viz/image.h"

namespace pendular::viz {

/// An off-screen window that draws at twice the picture's resolution and averages 2 × 2 pixels: smooth edges
/// without depending on what antialiasing the machine's OpenGL offers. Sizes given to VTK in pixels (text,
/// line widths) go through scaled().
class Canvas {
 public:
  /// On a connection that closes after it.
  Canvas(_XDisplay* connection, PictureSize size);

  vtkRenderWindow* window() { return window_; }

  /// Window pixels for a length that is `length` pixels in a picture 1200 pixels high.
  int scaled(double length) const;

  /// Draws and reads back. ComputationFailed where OpenGL draws nothing.
  Image draw();

 private:
  PictureSize size_;
  vtkNew<vtkRenderWindow> window_;
};

/// What a canvas shows while it lives: a scene at the left below the title, and text and colour bar behind
/// it.
class Page {
 public:
  explicit Page(Canvas& canvas);
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  vtkNew<vtkRenderer> scene, annotation;

 private:
  vtkRenderWindow* window_;
};

}  // namespace pendular::viz
