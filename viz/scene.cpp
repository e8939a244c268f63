#include "viz/scene.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCylinderSource.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkLineSource.h>
#include <vtkOpenGLSphereMapper.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "viz/annotation.h"
#include "viz/canvas.h"
#include "viz/colours.h"

namespace pendular::viz {
namespace {

constexpr double kMillimetre =
    1e3;  // the scenes are in mm, so that single precision and camera defaults serve

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

/// Towards the camera: with the dip to the right and z up.
Vec3 towards_camera(const Stage& stage) {
  return stage.dip.cross(Vec3::UnitZ());
}

/// How far a bead lay before the cutting plane before loading, m; the choice does not change from frame to
/// frame.
double before_plane(const Frame& frame, const Stage& stage, int bead) {
  return (frame.origin(static_cast<std::size_t>(bead)) - stage.centre).dot(towards_camera(stage));
}

bool shown(const View& view, const Frame& frame, const Stage& stage, int bead) {
  return !view.half || before_plane(frame, stage, bead) <= 0.0;
}

double bead_value(const View& view, const Frame& frame, std::size_t i) {
  switch (view.colour) {
    case View::Colour::displacement:
      return frame.displacement[i].norm() * 1e6;
    case View::Colour::shear_strain:
      return frame.shear_strain[i];
    case View::Colour::damage:
      return frame.damage[i];
    case View::Colour::force:
      return 0.0;
  }
  return 0.0;
}

/// Pairs of the strong network (above the mean compressive force; Radjai et al. 1998, Phys. Rev. Lett. 80,
/// 61) in a slab three beads thick behind the cutting plane.
std::vector<std::size_t> strong_pairs(const Frame& frame, const Stage& stage) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < frame.pairs.size(); ++k)
    if (frame.force[k] > 0.0) {
      sum += frame.force[k];
      count += 1.0;
    }
  std::vector<std::size_t> strong;
  for (std::size_t k = 0; k < frame.pairs.size(); ++k) {
    if (!(frame.force[k] * count > sum)) continue;
    const auto [i, j] = frame.pairs[k];
    const double slab = 3.0 * frame.diameter[static_cast<std::size_t>(i)];
    const auto inside = [&](int bead) {
      const double depth = -before_plane(frame, stage, bead);
      return depth >= 0.0 && depth <= slab;
    };
    if (inside(i) && inside(j)) strong.push_back(k);
  }
  return strong;
}

vtkSmartPointer<vtkActor> sphere_actor(const std::vector<Vec3>& centres, const std::vector<double>& radii,
                                       const std::vector<double>& values, vtkScalarsToColors* map) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> radius;
  radius->SetName("radius");
  vtkNew<vtkDoubleArray> value;
  value->SetName("value");
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const Vec3 p = centres[k] * kMillimetre;
    const vtkIdType point = points->InsertNextPoint(p.data());
    cells->InsertNextCell(1, &point);
    radius->InsertNextValue(static_cast<float>(radii[k] * kMillimetre));
    if (map != nullptr) value->InsertNextValue(values[k]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  data->GetPointData()->AddArray(radius);
  vtkNew<vtkOpenGLSphereMapper> mapper;
  mapper->SetScaleArray("radius");
  if (map != nullptr) {
    data->GetPointData()->SetScalars(value);
    mapper->SetLookupTable(map);
    mapper->UseLookupTableScalarRangeOn();
  } else {
    mapper->ScalarVisibilityOff();
  }
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.7);
  actor->GetProperty()->SetSpecular(0.0);
  return actor;
}

void add_beads(vtkRenderer* renderer, const View& view, const Frame& frame, const Stage& stage,
               vtkScalarsToColors* map) {
  std::vector<Vec3> centres;
  std::vector<double> radii, values;
  for (std::size_t i = 0; i < frame.position.size(); ++i)
    if (shown(view, frame, stage, static_cast<int>(i))) {
      centres.push_back(frame.position[i]);
      radii.push_back(0.5 * frame.diameter[i]);
      values.push_back(bead_value(view, frame, i));
    }
  renderer->AddActor(sphere_actor(centres, radii, values, map));
}

void add_broken_bonds(vtkRenderer* renderer, const View& view, const Frame& frame, const Stage& stage) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t k = 0; k < frame.pairs.size(); ++k) {
    const auto [i, j] = frame.pairs[k];
    if (frame.state[k] != Frame::Pair::broken || !shown(view, frame, stage, i) ||
        !shown(view, frame, stage, j))
      continue;
    const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    centres.push_back(0.5 * (frame.position[a] + frame.position[b]));
    radii.push_back(0.15 * frame.diameter[a]);
  }
  const auto actor = sphere_actor(centres, radii, {}, nullptr);
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

}  // namespace

const std::vector<View>& views() {
  static const std::vector<View> all = {
      {.name = "displacement",
       .title = "Bead displacement",
       .colour = View::Colour::displacement,
       .caption = "Specimen between the platens, beads coloured by the magnitude of their displacement."},
      {.name = "displacement_cut",
       .title = "Bead displacement, cut through the axis",
       .colour = View::Colour::displacement,
       .half = true,
       .caption = "Half specimen behind a vertical plane that contains the dip of the shear band, beads "
                  "coloured by the "
                  "magnitude of their displacement."},
      {.name = "shear_strain",
       .title = "Local shear strain, cut through the axis",
       .colour = View::Colour::shear_strain,
       .half = true,
       .caption = "Half specimen, beads coloured by local shear strain; strokes beside the specimen mark the "
                  "plane fitted "
                  "to the shear band."},
      {.name = "damage",
       .title = "Broken bonds, cut through the axis",
       .colour = View::Colour::damage,
       .half = true,
       .broken_bonds = true,
       .caption = "Half specimen, beads coloured by the share of their first bonds that broke."},
      {.name = "broken_bonds",
       .title = "Sites of broken bonds, whole specimen",
       .colour = View::Colour::damage,
       .beads = false,
       .broken_bonds = true,
       .caption = "Every broken bond of the specimen, seen along the strike of the shear band."},
      {.name = "force_chains",
       .title = "Strong compressive forces behind the cut",
       .colour = View::Colour::force,
       .half = true,
       .beads = false,
       .force_chains = true,
       .caption = "Pairs that carry more than the mean compressive force, in a slab three beads thick behind "
                  "the cut; width "
                  "and colour by normal force."}};
  return all;
}

const View& view_named(const std::string& name) {
  std::string known;
  for (const View& view : views()) {
    if (view.name == name) return view;
    known += (known.empty() ? "" : ", ") + view.name;
  }
  bad_input("view: found {}, expected one of {}", name, known);
}

Stage make_stage(const Frame& first, const Frame& last, const RunResult& result) {
  Stage stage;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < first.position.size(); ++i) {
    const Eigen::Vector2d p = first.origin(i).head<2>(),
                          r = Eigen::Vector2d::Constant(0.5 * first.diameter[i]);
    box.extend(p - r);
    box.extend(p + r);
  }
  stage.centre = Vec3(box.center().x(), box.center().y(), 0.5 * (first.platen_bottom + first.platen_top));
  stage.radius = 0.5 * first.specimen_diameter;
  stage.bottom = first.platen_bottom;
  stage.top = first.platen_top;
  stage.extent = stage.radius;
  for (const Frame* frame : {&first, &last}) {
    std::vector<double> reach;
    for (std::size_t i = 0; i < frame->position.size(); ++i)
      reach.push_back((frame->position[i] - stage.centre).head<2>().norm() + 0.5 * frame->diameter[i]);
    stage.extent =
        std::max(stage.extent, robust_range(reach).high);  // beads that broke away do not set the scale
  }
  stage.band = result.band;
  if (stage.band && stage.band->normal.head<2>().norm() > 1e-3)
    stage.dip = Vec3(stage.band->normal.x(), stage.band->normal.y(), 0.0).normalized();
  return stage;
}

ColourRange colour_range(const View& view, const Frame& frame, const Stage& stage) {
  std::vector<double> values;
  if (view.colour == View::Colour::force) {
    for (std::size_t k : strong_pairs(frame, stage)) values.push_back(frame.force[k] * 1e3);
  } else {
    for (std::size_t i = 0; i < frame.position.size(); ++i)
      if (shown(view, frame, stage, static_cast<int>(i)) &&
          (view.colour != View::Colour::shear_strain || frame.coordination[i] > 0.0))
        values.push_back(bead_value(view, frame, i));
  }
  const Range range = robust_range(values, 0.02, view.colour == View::Colour::shear_strain ? 0.95 : 0.98);
  const bool from_zero = view.colour == View::Colour::damage || view.colour == View::Colour::force;
  return {from_zero ? 0.0 : range.low, range.high};
}

Image draw_scene(const Display& display, const View& view, const Frame& frame, const Stage& stage,
                 const ColourRange& range, PictureSize size) {
  Canvas canvas(display, size);
  canvas.window()->SetNumberOfLayers(2);
  const auto map = colours(colour_map(view.colour), {range.low, range.high});

  vtkNew<vtkRenderer> scene, annotation;
  scene->SetBackground(1.0, 1.0, 1.0);
  annotation->SetBackground(1.0, 1.0, 1.0);
  annotation->SetLayer(0);
  scene->SetLayer(1);
  scene->SetViewport(0.01, 0.01, 0.79, 0.87);
  canvas.window()->AddRenderer(annotation);
  canvas.window()->AddRenderer(scene);

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

}  // namespace pendular::viz
