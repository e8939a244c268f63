#include "viz/scene_content.h"

namespace pendular::viz {
namespace {

/// How far a bead lay before the cutting plane before loading, m.
double before_plane(const Frame& frame, const Stage& stage, int bead) {
  return (frame.origin(static_cast<std::size_t>(bead)) - stage.centre).dot(towards_camera(stage));
}

}  // namespace

Vec3 towards_camera(const Stage& stage) {
  return stage.dip.cross(Vec3::UnitZ());
}

bool is_shown(const View& view, const Frame& frame, const Stage& stage, int bead) {
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

}  // namespace pendular::viz
