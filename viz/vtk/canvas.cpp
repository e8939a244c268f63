#include "viz/vtk/canvas.h"

#include <vtkImageData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pendular::viz {
namespace {

constexpr int kOversample = 2;

/// Means of 2 × 2 pixels, rows turned to run from the top.
Image averaged(const vtkUnsignedCharArray& pixels, PictureSize size) {
  Image image{size.width, size.height, {}};
  const std::size_t width = static_cast<std::size_t>(size.width),
                    height = static_cast<std::size_t>(size.height);
  image.rgb.resize(3 * width * height);
  const std::uint8_t* from = const_cast<vtkUnsignedCharArray&>(pixels).GetPointer(0);
  const std::size_t row = 3 * width * kOversample;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint8_t* p = from + (height - 1 - y) * kOversample * row + x * kOversample * 3 + c;
        image.rgb[3 * (y * width + x) + c] =
            static_cast<std::uint8_t>((p[0] + p[3] + p[row] + p[row + 3] + 2) / 4);
      }
  return image;
}

}  // namespace

Canvas::Canvas(_XDisplay* connection, PictureSize size) : size_(size) {
  window_->SetDisplayId(connection);
  window_->SetOffScreenRendering(1);
  window_->SetMultiSamples(0);
  window_->SetSize(size.width * kOversample, size.height * kOversample);
  window_->SetNumberOfLayers(2);
  annotation_->SetBackground(1.0, 1.0, 1.0);
  annotation_->SetLayer(0);
  scene_->SetBackground(1.0, 1.0, 1.0);
  scene_->SetLayer(1);
  scene_->SetViewport(0.01, 0.01, 0.79, 0.87);
  window_->AddRenderer(annotation_);
  window_->AddRenderer(scene_);
}

int Canvas::scaled(double length) const {
  return static_cast<int>(std::lround(length * kOversample * size_.height / 1200.0));
}

Image Canvas::draw() {
  window_->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window_->GetPixelData(0, 0, size_.width * kOversample - 1, size_.height * kOversample - 1, 0, pixels);
  scene_->RemoveAllViewProps();
  annotation_->RemoveAllViewProps();
  const vtkIdType expected = 3LL * size_.width * size_.height * kOversample * kOversample;
  Image image;
  if (pixels->GetNumberOfValues() == expected) image = averaged(*pixels, size_);
  // Every picture has a white background: an all-black one was never drawn.
  if (std::all_of(image.rgb.begin(), image.rgb.end(), [](std::uint8_t v) { return v == 0; }))
    throw ComputationFailed("the X display draws no OpenGL 3.2 (unset DISPLAY to use a private Xvfb)");
  return image;
}

}  // namespace pendular::viz
