#include "run_folder/frame.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "run_folder/run_folder.h"

namespace pendular {
namespace {

constexpr double kUm = 1e6, kMicrometre = 1e-6;

double field(const PolyTable& table, const std::string& name, const fs::path& path) {
  const auto found = table.number_fields.find(name);
  if (found == table.number_fields.end())
    bad_input("{}: found no field {}, expected a frame of a run", path.string(), name);
  if (!std::isfinite(found->second))
    bad_input("{}: {}: found {}, expected a number", path.string(), name, found->second);
  return found->second;
}

template <typename T>
std::vector<T> scaled(std::vector<T> values, double unit) {
  for (T& value : values) value *= unit;
  return values;
}

std::vector<RunFrame::Line> lines_of(const PolyTable& table, const fs::path& path) {
  std::vector<RunFrame::Line> lines;
  for (const std::int64_t code : integers(table, false, "state", path)) {
    if (code < 0 || code > 2) bad_input("{}: state: found {}, expected 0, 1 or 2", path.string(), code);
    lines.push_back(static_cast<RunFrame::Line>(code));
  }
  return lines;
}

}  // namespace

PolyTable table_of(const RunFrame& frame) {
  PolyTable table;
  std::vector<std::int64_t> states;
  for (const auto line : frame.lines) states.push_back(static_cast<std::int64_t>(line));
  table.points = scaled(frame.position, kUm);
  table.lines = frame.pairs;
  table.point_data = {{"bead_id", frame.ids},
                      {"diameter_um", scaled(frame.diameter, kUm)},
                      {"displacement_um", scaled(frame.displacement, kUm)}};
  table.line_data = {{"state", states}};
  table.number_fields = {{"strain", frame.strain},
                         {"stress_pa", frame.stress},
                         {"platen_bottom_um", kUm * frame.platen_bottom},
                         {"platen_top_um", kUm * frame.platen_top},
                         {"specimen_diameter_um", kUm * frame.specimen_diameter}};
  table.text_fields = {{"units", "coordinates in um; SI or the unit in an array's name otherwise"},
                       {"line_states", "0 bond, 1 broken bond, 2 contact without bond"}};
  return table;
}

RunFrame run_frame(const PolyTable& table, const fs::path& path) {
  if (table.points.empty()) bad_input("{}: found no beads, expected at least one", path.string());
  RunFrame frame;
  frame.strain = field(table, "strain", path);
  frame.stress = field(table, "stress_pa", path);
  frame.platen_bottom = field(table, "platen_bottom_um", path) * kMicrometre;
  frame.platen_top = field(table, "platen_top_um", path) * kMicrometre;
  frame.specimen_diameter = field(table, "specimen_diameter_um", path) * kMicrometre;
  frame.ids = integers(table, true, "bead_id", path);
  frame.position = scaled(table.points, kMicrometre);
  frame.displacement = scaled(vectors(table, true, "displacement_um", path), kMicrometre);
  frame.diameter = scaled(numbers(table, true, "diameter_um", path), kMicrometre);
  frame.pairs = table.lines;
  frame.lines = lines_of(table, path);
  for (const Vec3& p : frame.position)
    if (!p.allFinite())
      bad_input("{}: found a position that is no number, expected finite ones", path.string());
  return frame;
}

std::vector<fs::path> frame_files(const fs::path& run) {
  return sorted_entries(run / run_file::kFrames, "frame_", ".vtp");
}

}  // namespace pendular
