#include "viz/frame.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "packing/polydata.h"

namespace pendular::viz {
namespace {

constexpr double kMicrometre = 1e-6;

double field(const PolyTable& table, const std::string& name, const fs::path& path) {
  const auto found = table.number_fields.find(name);
  if (found == table.number_fields.end())
    bad_input("{}: found no field {}, expected a frame of a run", path.string(), name);
  if (!std::isfinite(found->second))
    bad_input("{}: {}: found {}, expected a number", path.string(), name, found->second);
  return found->second;
}

std::vector<Vec3> in_metres(std::vector<Vec3> vectors) {
  for (Vec3& v : vectors) v *= kMicrometre;
  return vectors;
}

std::vector<Frame::Pair> pair_states(const PolyTable& table, const fs::path& path) {
  std::vector<Frame::Pair> states;
  for (std::int64_t code : integers(table, false, "state", path)) {
    if (code < 0 || code > 2) bad_input("{}: state: found {}, expected 0, 1 or 2", path.string(), code);
    states.push_back(static_cast<Frame::Pair>(code));
  }
  return states;
}

}  // namespace

Frame read_frame(const fs::path& path) {
  const PolyTable table = read_polydata(path);
  if (table.points.empty()) bad_input("{}: found no beads, expected at least one", path.string());
  Frame frame;
  frame.strain = field(table, "strain", path);
  frame.stress = field(table, "stress_pa", path);
  frame.platen_bottom = field(table, "platen_bottom_um", path) * kMicrometre;
  frame.platen_top = field(table, "platen_top_um", path) * kMicrometre;
  frame.specimen_diameter = field(table, "specimen_diameter_um", path) * kMicrometre;
  frame.position = in_metres(table.points);
  frame.displacement = in_metres(vectors(table, true, "displacement_um", path));
  frame.diameter = numbers(table, true, "diameter_um", path);
  for (double& d : frame.diameter) d *= kMicrometre;
  frame.shear_strain = numbers(table, true, "local_shear_strain", path);
  frame.coordination = numbers(table, true, "coordination", path);
  frame.damage = numbers(table, true, "damage", path);
  frame.pairs = table.lines;
  frame.force = numbers(table, false, "normal_force_n", path);
  frame.state = pair_states(table, path);
  for (const Vec3& p : frame.position)
    if (!p.allFinite())
      bad_input("{}: found a position that is no number, expected finite ones", path.string());
  return frame;
}

double interior_coordination(const Frame& frame) {
  const std::size_t beads = frame.position.size();
  const double mean_diameter =
      std::accumulate(frame.diameter.begin(), frame.diameter.end(), 0.0) / static_cast<double>(beads);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < beads; ++i) {
    box.extend(frame.position[i] - Vec3::Constant(0.5 * frame.diameter[i]));
    box.extend(frame.position[i] + Vec3::Constant(0.5 * frame.diameter[i]));
  }
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < beads; ++i) {
    const Vec3& p = frame.position[i];
    const double from_axis = (p - box.center()).head<2>().norm();
    if (from_axis > 0.5 * frame.specimen_diameter - mean_diameter) continue;
    if (p.z() < box.min().z() + mean_diameter || p.z() > box.max().z() - mean_diameter) continue;
    sum += frame.coordination[i];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pendular::viz
