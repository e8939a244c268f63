#include "viz/frame.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "packing/polydata.h"

namespace pendular::viz {
Frame read_frame(const fs::path& path) {
  const PolyTable table = read_polydata(path);
  const RunFrame read = run_frame(table, path);
  Frame frame;
  frame.strain = read.strain, frame.stress = read.stress;
  frame.platen_bottom = read.platen_bottom, frame.platen_top = read.platen_top;
  frame.specimen_diameter = read.specimen_diameter;
  frame.position = read.position, frame.displacement = read.displacement;
  frame.diameter = read.diameter;
  frame.shear_strain = numbers(table, true, "local_shear_strain", path);
  frame.coordination = numbers(table, true, "coordination", path);
  frame.damage = numbers(table, true, "damage", path);
  frame.pairs = read.pairs;
  frame.force = numbers(table, false, "normal_force_n", path);
  frame.state = read.lines;
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
