#include "packing/exchange_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "base/interrupt.h"
#include "packing/polydata.h"

namespace pendular {
namespace {

constexpr double um = 1e-6;

double strain_of(const PolyTable& frame, const fs::path& path) {
  const auto found = frame.number_fields.find("strain");
  if (found == frame.number_fields.end())
    bad_input("{}: found no field strain, expected a frame of a run", path.string());
  return found->second;
}

std::string in_xml(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '&' || c == '<' || c == '>' || c == '"')
      out += fmt::format("&#{};", static_cast<int>(c));
    else
      out += c;
  return out;
}

/// A column of a dump: its name there, and the text of a row.
struct Column {
  std::string name;
  std::function<void(std::string&, std::size_t)> add;
};

template <typename T>
Column column(const std::string& name, const std::vector<T>& values) {
  return {name, [&values](std::string& out, std::size_t row) {
            fmt::format_to(std::back_inserter(out), " {}", values[row]);
          }};
}

/// Every array that `skipped` does not name; vectors as three columns.
std::vector<Column> columns_of(const std::vector<std::pair<std::string, PolyTable::Array>>& arrays,
                               const std::vector<std::string>& skipped) {
  std::vector<Column> columns;
  for (const auto& [name, array] : arrays) {
    if (std::find(skipped.begin(), skipped.end(), name) != skipped.end()) continue;
    if (const auto* vectors = std::get_if<std::vector<Vec3>>(&array)) {
      for (int axis = 0; axis < 3; ++axis)
        columns.push_back(
            {fmt::format("{}_{}", name, "xyz"[axis]), [vectors, axis](std::string& out, std::size_t row) {
               fmt::format_to(std::back_inserter(out), " {}", (*vectors)[row][axis]);
             }});
    } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&array)) {
      columns.push_back(column(name, *whole));
    } else {
      columns.push_back(column(name, std::get<std::vector<double>>(array)));
    }
  }
  return columns;
}

std::string names_of(const std::vector<Column>& columns) {
  std::string text;
  for (const Column& one : columns) text += ' ' + one.name;
  return text;
}

/// What a frame's beads and pairs share: step, time, and the box that holds every bead.
std::string snapshot_head(std::size_t step, double strain, const std::string& what, std::size_t count,
                          const Eigen::AlignedBox3d& box) {
  std::string text = fmt::format(
      "ITEM: UNITS\nsi\nITEM: TIME\n{}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF {}\n{}\n"
      "ITEM: BOX BOUNDS ff ff ff\n",
      strain, step, what, count);
  for (int axis = 0; axis < 3; ++axis) text += fmt::format("{} {}\n", box.min()[axis], box.max()[axis]);
  return text;
}

void add_frame(const fs::path& path, std::size_t step, std::string& beads, std::string& bonds) {
  const PolyTable frame = read_polydata(path);
  const double strain = strain_of(frame, path);
  const auto ids = integers(frame, true, "bead_id", path);
  const auto diameter = numbers(frame, true, "diameter_um", path);
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < ids.size(); ++k)
    for (const double side : {-0.5, 0.5})
      box.extend(um * (frame.points[k] + Vec3::Constant(side * diameter[k])));
  const auto of_beads = columns_of(frame.point_data, {"bead_id", "diameter_um"});
  beads += snapshot_head(step, strain, "ATOMS", ids.size(), box) + "ITEM: ATOMS id type radius x y z" +
           names_of(of_beads) + '\n';
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const Vec3 at = um * frame.points[k];
    fmt::format_to(std::back_inserter(beads), "{} 1 {} {} {} {}", ids[k], 0.5 * um * diameter[k], at.x(),
                   at.y(), at.z());
    for (const Column& one : of_beads) one.add(beads, k);
    beads += '\n';
  }
  const auto of_pairs = columns_of(frame.line_data, {"state"});
  bonds += snapshot_head(step, strain, "ENTRIES", frame.lines.size(), box) +
           "ITEM: ENTRIES index batom1 batom2 btype" + names_of(of_pairs) + '\n';
  if (frame.lines.empty()) return;
  const auto state = integers(frame, false, "state", path);
  for (std::size_t k = 0; k < frame.lines.size(); ++k) {
    const auto id_of = [&](int end) { return ids[static_cast<std::size_t>(end)]; };
    fmt::format_to(std::back_inserter(bonds), "{} {} {} {}", k + 1, id_of(frame.lines[k][0]),
                   id_of(frame.lines[k][1]), state[k] + 1);
    for (const Column& one : of_pairs) one.add(bonds, k);
    bonds += '\n';
  }
}

}  // namespace

std::vector<fs::path> run_frames(const fs::path& run) {
  std::vector<fs::path> frames = files_in(run / "frames");
  std::erase_if(frames, [](const fs::path& file) {
    return !file.filename().string().starts_with("frame_") || file.extension() != ".vtp";
  });
  if (frames.empty()) bad_input("{}: found no frame_*.vtp, expected at least one", (run / "frames").string());
  return frames;
}

void write_pvd(const fs::path& path, const fs::path& run) {
  const fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <!-- time: strain -->\n  <Collection>\n";
  for (const fs::path& frame : run_frames(run)) {
    stop_if_interrupted();
    const fs::path name = fs::absolute(frame).lexically_normal().lexically_relative(folder);
    text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n",
                        strain_of(read_polydata(frame), frame), in_xml(name.generic_string()));
  }
  write_text(path, text + "  </Collection>\n</VTKFile>\n");
}

fs::path bonds_beside(const fs::path& dump) {
  return fs::path(dump).replace_extension(".bonds" + dump.extension().string());
}

void write_dump(const fs::path& path, const fs::path& run) {
  std::string beads, bonds;
  std::size_t step = 0;
  for (const fs::path& frame : run_frames(run)) {
    stop_if_interrupted();
    add_frame(frame, step++, beads, bonds);
  }
  WrittenTogether written;
  write_text(path, beads);
  write_text(bonds_beside(path), bonds);
  written.commit();
}

}  // namespace pendular
