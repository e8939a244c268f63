#include <vtkCamera.h>

#include <algorithm>

#include "viz/vtk/annotation.h"
#include "viz/vtk/pictures.h"
#include "viz/vtk/spheres.h"

namespace pendular::viz {
namespace {

/// The beads behind a plane across y, m.
vtkSmartPointer<vtkActor> far_half(const BeadMap& map, double plane, vtkScalarsToColors* colour) {
  std::vector<Vec3> centres;
  std::vector<double> radii, values;
  for (std::size_t k = 0; k < map.centres.size(); ++k) {
    if (map.centres[k].y() < plane) continue;
    centres.push_back(map.centres[k]);
    radii.push_back(0.5 * map.diameters[k]);
    values.push_back(map.values[k]);
  }
  return spheres(centres, radii, values, colour);
}

Image draw_in(Canvas& canvas, const BeadMap& map) {
  Vec3 low = map.centres.front(), high = low;
  for (const Vec3& p : map.centres) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 middle = kMillimetre * 0.5 * (low + high);
  const auto colour =
      colours(map.is_signed ? ColourMap::signed_values : ColourMap::alarm, {map.low, map.high});
  vtkRenderer *scene = canvas.scene(), *annotation = canvas.annotation();
  scene->AddActor(far_half(map, 0.5 * (low.y() + high.y()), colour));
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
  return canvas.draw();
}

}  // namespace

std::vector<Image> bead_map_pictures(_XDisplay* connection, std::span<const BeadMap> maps, PictureSize size) {
  std::vector<Image> images;
  Canvas canvas(connection, size);
  for (const BeadMap& map : maps) images.push_back(draw_in(canvas, map));
  return images;
}

}  // namespace pendular::viz
