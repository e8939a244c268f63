#include "viz/annotation.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <array>

#include "viz/ticks.h"

namespace pendular::viz {
namespace {

constexpr double kInk = 0.05;

struct Box {
  double left, bottom, right, top;
};
constexpr Box kBar{0.845, 0.24, 0.875, 0.76};

using Rgb = std::array<unsigned char, 3>;

/// Coloured rectangles in shares of the picture.
void add_boxes(vtkRenderer* renderer, const std::vector<Box>& boxes,
               const std::vector<Rgb>& colours_of_boxes) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  vtkNew<vtkUnsignedCharArray> rgb;
  rgb->SetNumberOfComponents(3);
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Box& b = boxes[k];
    quads->InsertNextCell(4);
    quads->InsertCellPoint(points->InsertNextPoint(b.left, b.bottom, 0.0));
    quads->InsertCellPoint(points->InsertNextPoint(b.right, b.bottom, 0.0));
    quads->InsertCellPoint(points->InsertNextPoint(b.right, b.top, 0.0));
    quads->InsertCellPoint(points->InsertNextPoint(b.left, b.top, 0.0));
    rgb->InsertNextTypedTuple(colours_of_boxes[k].data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(quads);
  data->GetCellData()->SetScalars(rgb);
  vtkNew<vtkCoordinate> shares;
  shares->SetCoordinateSystemToNormalizedViewport();
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  mapper->SetTransformCoordinate(shares);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  renderer->AddViewProp(actor);
}

}  // namespace

void add_text(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double x, double y,
              const TextStyle& style) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(canvas.scaled(style.size));
  property->SetBold(style.bold);
  property->SetColor(kInk, kInk, kInk);
  property->SetVerticalJustificationToCentered();
  property->SetOrientation(style.angle);
  if (style.align == Align::centre) property->SetJustificationToCentered();
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  renderer->AddViewProp(actor);
}

void add_colour_bar(vtkRenderer* renderer, const Canvas& canvas, const std::string& title, Range range,
                    vtkScalarsToColors* map) {
  constexpr int kSteps = 256;
  const double height = kBar.top - kBar.bottom, line = 0.0025;
  std::vector<Box> boxes = {{kBar.left - 0.001, kBar.bottom - 0.0015, kBar.right + 0.001, kBar.top + 0.0015}};
  std::vector<Rgb> rgb = {{13, 13, 13}};
  for (int k = 0; k < kSteps; ++k) {
    const unsigned char* c = map->MapValue(range.low + (range.high - range.low) * (k + 0.5) / kSteps);
    boxes.push_back(
        {kBar.left, kBar.bottom + height * k / kSteps, kBar.right, kBar.bottom + height * (k + 1) / kSteps});
    rgb.push_back({c[0], c[1], c[2]});
  }
  const Ticks ticks = round_ticks(range.low, range.high, 5);
  for (std::size_t k = 0; k < ticks.values.size(); ++k) {
    const double y = kBar.bottom + height * (ticks.values[k] - range.low) / (range.high - range.low);
    boxes.push_back({kBar.right, y - 0.5 * line, kBar.right + 0.007, y + 0.5 * line});
    rgb.push_back({13, 13, 13});
    add_text(renderer, canvas, ticks.labels[k], kBar.right + 0.013, y, {.size = 32});
  }
  add_boxes(renderer, boxes, rgb);
  add_text(renderer, canvas, title, 0.885, kBar.top + 0.05, {.size = 32, .align = Align::centre});
}

void add_length_scale(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double share) {
  constexpr double kMiddle = 0.885, kHeight = 0.09;
  add_boxes(renderer, {{kMiddle - 0.5 * share, kHeight, kMiddle + 0.5 * share, kHeight + 0.008}},
            {{13, 13, 13}});
  add_text(renderer, canvas, text, kMiddle, kHeight + 0.04, {.size = 32, .align = Align::centre});
}

}  // namespace pendular::viz
