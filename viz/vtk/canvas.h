#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "viz/display.h"
#include "viz/image.h"

namespace pendular::viz {

/// An off-screen window that draws at twice the picture's resolution and averages 2 × 2 pixels: smooth edges
/// without depending on what antialiasing the machine's OpenGL offers. Sizes given to VTK in pixels (text,
/// line widths) go through scaled(). A scene stands at the left below the title; text and colour bar lie
/// behind it. Serves for many pictures, one after the other: a window takes longer to make than a picture to
/// draw.
class Canvas {
 public:
  /// On a connection that closes after it.
  Canvas(_XDisplay* connection, PictureSize size);

  vtkRenderer* scene() { return scene_; }
  vtkRenderer* annotation() { return annotation_; }

  /// Window pixels for a length that is `length` pixels in a picture 1200 pixels high.
  int scaled(double length) const;

  /// Draws, reads back and clears. ComputationFailed where OpenGL draws nothing.
  Image draw();

 private:
  PictureSize size_;
  vtkNew<vtkRenderer> scene_, annotation_;
  vtkNew<vtkRenderWindow> window_;
};

}  // namespace pendular::viz
