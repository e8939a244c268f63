#include "viz/vtk/annotation.h"

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

#include "viz/ticks.h"

namespace pendular::viz {
namespace {

constexpr double kInk = 0.05;

}  // namespace

void add_boxes(vtkRenderer* renderer, const std::vector<Box>& boxes, const std::vector<Rgb>& colours) {
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
    rgb->InsertNextTypedTuple(colours[k].data());
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

void add_text(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double x, double y,
              const TextStyle& style) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(canvas.scaled(style.size));
  property->SetBold(style.bold);
  const double ink = style.white ? 1.0 : kInk;
  property->SetColor(ink, ink, ink);
  property->SetVerticalJustificationToCentered();
  property->SetOrientation(style.angle);
  if (style.align == Align::centre) property->SetJustificationToCentered();
  if (style.align == Align::right) property->SetJustificationToRight();
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  renderer->AddViewProp(actor);
}

vtkSmartPointer<vtkColorTransferFunction> colours(ColourMap map, Range range) {
  const auto stations = colours_of(map);
  auto function = vtkSmartPointer<vtkColorTransferFunction>::New();
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(stations.size() - 1);
    const auto& [r, g, b] = stations[k];
    function->AddRGBPoint(range.low + t * (range.high - range.low), r, g, b);
  }
  function->SetNanColor(0.6, 0.6, 0.6);
  return function;
}

void add_colour_bar(vtkRenderer* renderer, const Canvas& canvas, const std::string& title, Range range,
                    vtkScalarsToColors* map, const Box& bar) {
  constexpr int kSteps = 256;
  const double height = bar.top - bar.bottom, line = 0.0025;
  std::vector<Box> boxes = {{bar.left - 0.001, bar.bottom - 0.0015, bar.right + 0.001, bar.top + 0.0015}};
  std::vector<Rgb> rgb = {{13, 13, 13}};
  for (int k = 0; k < kSteps; ++k) {
    const unsigned char* c = map->MapValue(range.low + (range.high - range.low) * (k + 0.5) / kSteps);
    boxes.push_back(
        {bar.left, bar.bottom + height * k / kSteps, bar.right, bar.bottom + height * (k + 1) / kSteps});
    rgb.push_back({c[0], c[1], c[2]});
  }
  const Ticks ticks = round_ticks(range.low, range.high, 5);
  for (std::size_t k = 0; k < ticks.values.size(); ++k) {
    const double y = bar.bottom + height * (ticks.values[k] - range.low) / (range.high - range.low);
    boxes.push_back({bar.right, y - 0.5 * line, bar.right + 0.007, y + 0.5 * line});
    rgb.push_back({13, 13, 13});
    add_text(renderer, canvas, ticks.labels[k], bar.right + 0.013, y, {.size = 32});
  }
  add_boxes(renderer, boxes, rgb);
  add_text(renderer, canvas, title, 0.5 * (bar.left + bar.right) + 0.025, bar.top + 0.05,
           {.size = 32, .align = Align::centre});
}

void add_length_scale(vtkRenderer* renderer, const Canvas& canvas, const std::string& text, double share) {
  constexpr double kMiddle = 0.885, kHeight = 0.09;
  add_boxes(renderer, {{kMiddle - 0.5 * share, kHeight, kMiddle + 0.5 * share, kHeight + 0.008}},
            {{13, 13, 13}});
  add_text(renderer, canvas, text, kMiddle, kHeight + 0.04, {.size = 32, .align = Align::centre});
}

}  // namespace pendular::viz
