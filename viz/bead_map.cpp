#include "viz/bead_map.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkOpenGLSphereMapper.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <algorithm>

#include "viz/annotation.h"
#include "viz/canvas.h"
#include "viz/colours.h"

namespace pendular::viz {
namespace {

constexpr double kMillimetre = 1e3;  // as in scene.cpp

void add_spheres(vtkRenderer* scene, const BeadMap& map, double plane, vtkScalarsToColors* colour) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> radius;
  radius->SetName("radius");
  vtkNew<vtkDoubleArray> value;
  value->SetName("value");
  for (std::size_t k = 0; k < map.centres.size(); ++k) {
    if (map.centres[k].y() < plane) continue;
    const Vec3 p = kMillimetre * map.centres[k];
    const vtkIdType point = points->InsertNextPoint(p.data());
    cells->InsertNextCell(1, &point);
    radius->InsertNextValue(static_cast<float>(0.5 * kMillimetre * map.diameters[k]));
    value->InsertNextValue(map.values[k]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  data->GetPointData()->AddArray(radius);
  data->GetPointData()->SetScalars(value);
  vtkNew<vtkOpenGLSphereMapper> mapper;
  mapper->SetScaleArray("radius");
  mapper->SetLookupTable(colour);
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.7);
  actor->GetProperty()->SetSpecular(0.0);
  scene->AddActor(actor);
}

Image draw_in(Canvas& canvas, const BeadMap& map) {
  Vec3 low = map.centres.front(), high = low;
  for (const Vec3& p : map.centres) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 middle = kMillimetre * 0.5 * (low + high);
  canvas.window()->SetNumberOfLayers(2);
  const auto colour =
      colours(map.is_signed ? ColourMap::signed_values : ColourMap::alarm, {map.low, map.high});
  vtkNew<vtkRenderer> scene, annotation;
  annotation->SetBackground(1.0, 1.0, 1.0);
  annotation->SetLayer(0);
  scene->SetBackground(1.0, 1.0, 1.0);
  scene->SetLayer(1);
  scene->SetViewport(0.01, 0.01, 0.79, 0.87);
  canvas.window()->AddRenderer(annotation);
  canvas.window()->AddRenderer(scene);
  add_spheres(scene, map, 0.5 * (low.y() + high.y()), colour);
  const double extent =
      kMillimetre * (std::max(high.z() - low.z(), high.x() - low.x()) + map.diameters.front());
  vtkCamera* camera = scene->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(middle.x(), middle.y(), middle.z());
  camera->SetPosition(middle.x(), middle.y() - 4.0 * extent, middle.z());
  camera->SetViewUp(0.0, 0.0, 1.0);
  camera->SetParallelScale(0.55 * extent);
  scene->ResetCameraClippingRange();
  add_text(annotation, canvas, map.title, 0.03, 0.945, {.size = 40, .bold = true});
  add_text(annotation, canvas, map.note, 0.03, 0.895);
  add_colour_bar(annotation, canvas, map.quantity, {map.low, map.high}, colour);
  Image image = canvas.draw();
  canvas.window()->RemoveRenderer(scene);
  canvas.window()->RemoveRenderer(annotation);
  return image;
}

}  // namespace

std::vector<Image> draw_bead_maps(const Display& display, std::span<const BeadMap> maps, PictureSize size) {
  std::vector<Image> images;
  Canvas canvas(display, size);  // its window takes longer to make than a picture to draw
  for (const BeadMap& map : maps) images.push_back(draw_in(canvas, map));
  return images;
}

}  // namespace pendular::viz
