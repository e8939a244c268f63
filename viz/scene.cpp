#include "viz/scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/own_process.h"
#include "viz/colours.h"
#include "viz/rendering.h"
#include "viz/scene_content.h"

namespace pendular::viz {

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
      if (is_shown(view, frame, stage, static_cast<int>(i)) &&
          (view.colour != View::Colour::shear_strain || frame.coordination[i] > 0.0))
        values.push_back(bead_value(view, frame, i));
  }
  const Range range = robust_range(values, 0.02, view.colour == View::Colour::shear_strain ? 0.95 : 0.98);
  const bool from_zero = view.colour == View::Colour::damage || view.colour == View::Colour::force;
  return {from_zero ? 0.0 : range.low, range.high};
}

ScenePainter::ScenePainter(const Display& display, PictureSize size) : connection_(display.connect()) {
  const SilentStandardError silent;
  pictures_ = rendering().scenes(connection_.get(), size);
}

ScenePainter::~ScenePainter() = default;

Image ScenePainter::draw(const View& view, const Frame& frame, const Stage& stage, const ColourRange& range) {
  const SilentStandardError silent;
  return pictures_->draw(view, frame, stage, range);
}

}  // namespace pendular::viz
