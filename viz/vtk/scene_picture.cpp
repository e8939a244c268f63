#include <fmt/format.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCylinderSource.h>
#include <vtkDoubleArray.h>
#include <vtkLineSource.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTubeFilter.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viz/scene_content.h"
#include "viz/vtk/annotation.h"
#include "viz/vtk/pictures.h"
#include "viz/vtk/spheres.h"

namespace pendular::viz {
namespace {

const char* bar_title(View::Colour colour) {
  switch (colour) {
    case View::Colour::displacement:
      return "displacement (\u00b5m)";
    case View::Colour::shear_strain:
      return "local shear strain";
    case View::Colour::damage:
      return "bonds broken (share)";
    case View::Colour::force:
      return "normal force (mN)";
  }
  return "";
}

ColourMap colour_map(View::Colour colour) {
  return colour == View::Colour::displacement ? ColourMap::rising : ColourMap::alarm;
}

void add_beads(vtkRenderer* renderer, const View& view, const Frame& frame, const Stage& stage,
               vtkScalarsToColors* map) {
  std::vector<Vec3> centres;
  std::vector<double> radii, values;
  for (std::size_t i = 0; i < frame.position.size(); ++i)
    if (is_shown(view, frame, stage, static_cast<int>(i))) {
      centres.push_back(frame.position[i]);
      radii.push_back(0.5 * frame.diameter[i]);
      values.push_back(bead_value(view, frame, i));
    }
  renderer->AddActor(spheres(centres, radii, values, map));
}

void add_broken_bonds(vtkRenderer* renderer, const View& view, const Frame& frame, const Stage& stage) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t k = 0; k < frame.pairs.size(); ++k) {
    const auto [i, j] = frame.pairs[k];
    if (frame.state[k] != Frame::Pair::broken || !is_shown(view, frame, stage, i) ||
        !is_shown(view, frame, stage, j))
      continue;
    const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    centres.push_back(0.5 * (frame.position[a] + frame.position[b]));
    radii.push_back(0.15 * frame.diameter[a]);
  }
  const auto actor = spheres(centres, radii);
  actor->GetProperty()->SetColor(0.80, 0.05, 0.05);
  renderer->AddActor(actor);
}

/// Tubes whose radius grows with the force, up to a third of a bead's at the upper end of the colours.
void add_force_chains(vtkRenderer* renderer, const Frame& frame, const Stage& stage, vtkScalarsToColors* map,
                      double high) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkDoubleArray> force, radius;
  force->SetName("force");
  radius->SetName("radius");
  for (std::size_t k : strong_pairs(frame, stage)) {
    lines->InsertNextCell(2);
    for (int bead : frame.pairs[k]) {
      const Vec3 p = frame.position[static_cast<std::size_t>(bead)] * kMillimetre;
      lines->InsertCellPoint(points->InsertNextPoint(p.data()));
      const double f = frame.force[k] * 1e3;
      force->InsertNextValue(f);
      radius->InsertNextValue(std::min(f / high, 1.5) * frame.diameter[static_cast<std::size_t>(bead)] *
                              kMillimetre / 6.0);
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetPointData()->AddArray(force);
  data->GetPointData()->SetScalars(radius);
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(data);
  tubes->SetVaryRadiusToVaryRadiusByAbsoluteScalar();
  tubes->SetNumberOfSides(12);
  tubes->CappingOn();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("force");
  mapper->SetLookupTable(map);
  mapper->UseLookupTableScalarRangeOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.7);
  renderer->AddActor(actor);
}

/// A vertical cylinder around the specimen's axis, m.
vtkSmartPointer<vtkActor> cylinder(const Stage& stage, double radius, double bottom, double top,
                                   bool capped) {
  vtkNew<vtkCylinderSource> source;
  source->SetRadius(radius * kMillimetre);
  source->SetHeight((top - bottom) * kMillimetre);
  source->SetResolution(128);
  source->SetCapping(capped);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->RotateX(90.0);  // VTK's cylinder stands along y
  actor->SetPosition(stage.centre.x() * kMillimetre, stage.centre.y() * kMillimetre,
                     0.5 * (top + bottom) * kMillimetre);
  return actor;
}

void add_platens(vtkRenderer* renderer, const Frame& frame, const Stage& stage) {
  const double radius = 1.06 * stage.extent, thickness = 0.04 * stage.radius;
  for (const auto& [bottom, top] : {std::pair{frame.platen_bottom - thickness, frame.platen_bottom},
                                    std::pair{frame.platen_top, frame.platen_top + thickness}}) {
    const auto actor = cylinder(stage, radius, bottom, top, true);
    actor->GetProperty()->SetColor(0.62, 0.68, 0.76);
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetOpacity(0.35);
    renderer->AddActor(actor);
  }
}

void add_mantle(vtkRenderer* renderer, const Frame& frame, const Stage& stage) {
  const auto actor = cylinder(stage, stage.extent, frame.platen_bottom, frame.platen_top, false);
  actor->GetProperty()->SetColor(0.6, 0.65, 0.7);
  actor->GetProperty()->SetOpacity(0.12);
  renderer->AddActor(actor);
}

/// Where the band's plane leaves the specimen in the cutting plane: a dark stroke on either side.
void add_band_trace(vtkRenderer* renderer, const Frame& frame, const Stage& stage, Canvas& canvas) {
  const Vec3 normal = stage.band->normal;
  const Vec3 along = normal.cross(towards_camera(stage)).normalized();
  // The plane's point that lies on the specimen's axis, and how far from it the trace leaves the specimen.
  Vec3 on_axis = stage.centre;
  on_axis.z() = stage.band->point.z();
  if (std::abs(normal.z()) > 1e-6)
    on_axis.z() += normal.head<2>().dot((stage.band->point - on_axis).head<2>()) / normal.z();
  if (on_axis.z() < frame.platen_bottom || on_axis.z() > frame.platen_top) return;
  const Vec3 upward = along.z() < 0.0 ? Vec3(-along) : along;
  const double sideways = stage.extent / std::max(std::abs(upward.dot(stage.dip)), 1e-9);
  const double slope = std::max(upward.z(), 1e-9);
  for (const auto& [direction, room] : {std::pair{upward, frame.platen_top - on_axis.z()},
                                        std::pair{Vec3(-upward), on_axis.z() - frame.platen_bottom}}) {
    const double leaves = std::min(sideways, room / slope);
    const Vec3 inner = (on_axis + direction * (leaves + 0.08 * stage.radius)) * kMillimetre;
    const Vec3 outer = (on_axis + direction * (leaves + 0.24 * stage.radius)) * kMillimetre;
    vtkNew<vtkLineSource> line;
    line->SetPoint1(inner.x(), inner.y(), inner.z());
    line->SetPoint2(outer.x(), outer.y(), outer.z());
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(line->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.05, 0.05, 0.05);
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetLineWidth(static_cast<float>(canvas.scaled(7)));
    renderer->AddActor(actor);
  }
}

void aim_camera(vtkRenderer* renderer, const Stage& stage) {
  constexpr double kElevation = 6.0 * std::numbers::pi / 180.0;  // enough to see that the platens are discs
  const Vec3 target =
      Vec3(stage.centre.x(), stage.centre.y(), 0.5 * (stage.bottom + stage.top)) * kMillimetre;
  const Vec3 back = std::cos(kElevation) * towards_camera(stage) + std::sin(kElevation) * Vec3::UnitZ();
  const double distance = 20.0 * stage.radius * kMillimetre;
  const Vec3 eye = target + distance * back;
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(target.x(), target.y(), target.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(0.0, 0.0, 1.0);
  const double tall =
      0.5 * (stage.top - stage.bottom) + 1.12 * stage.radius * std::sin(kElevation) + 0.06 * stage.radius;
  const double wide = 1.22 * std::max(stage.extent, stage.radius);
  double* viewport = renderer->GetViewport();
  const double aspect = (viewport[2] - viewport[0]) / (viewport[3] - viewport[1]) * 4.0 / 3.0;
  camera->SetParallelScale(1.04 * std::max(tall, wide / aspect) * kMillimetre);
  renderer->ResetCameraClippingRange();
}

/// A length in mm as a share of the picture's width.
double picture_share(vtkRenderer* renderer, PictureSize size, double length) {
  const double* viewport = renderer->GetViewport();
  const double pixels_per_mm =
      0.5 * (viewport[3] - viewport[1]) * size.height / renderer->GetActiveCamera()->GetParallelScale();
  return length * pixels_per_mm / size.width;
}

std::string state_line(const Frame& frame, const Stage& stage) {
  std::string line = fmt::format("strain {:.2f} %", 100.0 * frame.strain);
  if (std::isfinite(frame.stress)) line += fmt::format(",  stress {:.3f} MPa", 1e-6 * frame.stress);
  if (stage.band)
    line += fmt::format(",  shear band at {:.0f}\u00b0 to the axis",
                        stage.band->angle_to_axis() * 180.0 / std::numbers::pi);
  return line;
}

Image draw_in(Canvas& canvas, PictureSize size, const View& view, const Frame& frame, const Stage& stage,
              const ColourRange& range) {
  const auto map = colours(colour_map(view.colour), {range.low, range.high});
  vtkRenderer *scene = canvas.scene(), *annotation = canvas.annotation();
  if (view.beads) add_beads(scene, view, frame, stage, map);
  if (view.broken_bonds) add_broken_bonds(scene, view, frame, stage);
  if (view.force_chains) add_force_chains(scene, frame, stage, map, range.high);
  if (!view.beads) add_mantle(scene, frame, stage);
  add_platens(scene, frame, stage);
  if (stage.band) add_band_trace(scene, frame, stage, canvas);
  aim_camera(scene, stage);

  add_text(annotation, canvas, view.title, 0.03, 0.945, {.size = 40, .bold = true});
  add_text(annotation, canvas, state_line(frame, stage), 0.03, 0.895);
  if (view.beads || view.force_chains)
    add_colour_bar(annotation, canvas, bar_title(view.colour), {range.low, range.high}, map);
  add_length_scale(annotation, canvas, "1 mm", picture_share(scene, size, 1.0));
  return canvas.draw();
}

class CanvasScenes : public ScenePictures {
 public:
  CanvasScenes(_XDisplay* connection, PictureSize size) : size_(size), canvas_(connection, size) {}
  Image draw(const View& view, const Frame& frame, const Stage& stage, const ColourRange& range) override {
    return draw_in(canvas_, size_, view, frame, stage, range);
  }

 private:
  PictureSize size_;
  Canvas canvas_;
};

}  // namespace

std::unique_ptr<ScenePictures> scene_pictures(_XDisplay* connection, PictureSize size) {
  return std::make_unique<CanvasScenes>(connection, size);
}

}  // namespace pendular::viz
