#include "packing/vtp.h"

#include <nlohmann/json.hpp>

#include <algorithm>

#include "base/columns.h"
#include "base/error.h"
#include "packing/check.h"
#include "packing/polydata.h"

namespace pendular {
namespace {

constexpr double um = 1e-6;
constexpr double kFormatVersion = 1.0;
constexpr const char* kStates = "0 candidate, 1 bridge, 2 none, 3 undetermined";

template <typename Item, typename Get>
auto column(const std::vector<Item>& items, const Get& get) {
  std::vector<decltype(get(items.front()))> values;
  values.reserve(items.size());
  for (const Item& item : items) values.push_back(get(item));
  return values;
}

/// As the file holds them: the names of the states in the order of kStates.
std::int64_t code_of(BridgeState state) {
  return static_cast<std::int64_t>(state);
}

BridgeState state_of(std::int64_t code, const fs::path& path) {
  if (code < 0 || code > code_of(BridgeState::undetermined))
    bad_input("{}: array state: found {}, expected {}", path.string(), code, kStates);
  return static_cast<BridgeState>(code);
}

double number_field(const PolyTable& table, const std::string& name, const fs::path& path) {
  const auto field = table.number_fields.find(name);
  if (field == table.number_fields.end())
    bad_input("{}: field data {} is missing, expected a packing written by pendular", path.string(), name);
  require_in_range(path.string(), "field data " + name, range_of(name), field->second);
  return field->second;
}

/// An array of numbers, in the range of its name.
std::vector<double> measured(const PolyTable& table, bool of_points, const std::string& name,
                             const fs::path& path) {
  auto values = numbers(table, of_points, name, path);
  const Range range = range_of(name);
  for (const double value : values) require_in_range(path.string(), "array " + name, range, value);
  return values;
}

Specimen specimen_of(const PolyTable& table, const fs::path& path) {
  const auto length = [&](const std::string& name) {
    return um * number_field(table, "specimen_" + name + "_um", path);
  };
  Specimen specimen{length("diameter"), length("height"), length("axis_x"), length("axis_y"),
                    length("bottom")};
  if (!(specimen.diameter > 0.0) || !(specimen.height > 0.0))
    bad_input("{}: specimen: found diameter {:.6g} um and height {:.6g} um, expected positive ones",
              path.string(), specimen.diameter / um, specimen.height / um);
  return specimen;
}

Provenance provenance_of(const PolyTable& table, const fs::path& path) {
  const auto text = table.text_fields.find("provenance");
  if (text == table.text_fields.end()) return {};
  try {
    return provenance_from_json(nlohmann::json::parse(text->second));
  } catch (const nlohmann::json::exception& error) {
    bad_input("{}: field data provenance: {}", path.string(), error.what());
  }
}

std::vector<Bead> beads_of(const PolyTable& table, const fs::path& path) {
  const auto ids = integers(table, true, "bead_id", path), boundary = integers(table, true, "boundary", path);
  const auto diameter = measured(table, true, "diameter_um", path);
  const auto sigma_centre = measured(table, true, "sigma_centre_um", path);
  const auto sigma_diameter = measured(table, true, "sigma_diameter_um", path);
  const auto quality = measured(table, true, "quality", path);
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < table.points.size(); ++k)
    beads.push_back({ids[k], um * table.points[k], um * diameter[k], um * sigma_centre[k],
                     um * sigma_diameter[k], quality[k], boundary[k] != 0});
  check_beads(beads, path.string());
  return beads;
}

std::vector<Bridge> bridges_of(const PolyTable& table, const fs::path& path) {
  if (table.lines.empty()) return {};
  const auto number = [&](const char* name) { return measured(table, false, name, path); };
  const auto gap_um = number("gap_um"), sigma_gap = number("sigma_gap_um"),
             probability = number("probability");
  const auto diameter = number("bridge_diameter_um"), sigma_diameter = number("sigma_bridge_diameter_um");
  const auto state = integers(table, false, "state", path);
  std::vector<Bridge> bridges;
  for (std::size_t k = 0; k < table.lines.size(); ++k) {
    const auto [i, j] = std::minmax(table.lines[k][0], table.lines[k][1]);
    bridges.push_back({i, j, um * gap_um[k], um * sigma_gap[k], probability[k], um * diameter[k],
                       um * sigma_diameter[k], state_of(state[k], path)});
  }
  const auto ends = [](const Bridge& b) { return std::pair(b.i, b.j); };
  std::sort(bridges.begin(), bridges.end(),
            [&](const Bridge& a, const Bridge& b) { return ends(a) < ends(b); });
  for (std::size_t k = 0; k < bridges.size(); ++k)
    if (bridges[k].i == bridges[k].j || (k > 0 && ends(bridges[k]) == ends(bridges[k - 1])))
      bad_input("{}: line between points {} and {}: found {}, expected each pair of beads once",
                path.string(), bridges[k].i, bridges[k].j,
                bridges[k].i == bridges[k].j ? "one bead joined to itself" : "it twice");
  return bridges;
}

}  // namespace

PolyTable to_polydata(const Packing& packing) {
  const auto flag = [](bool value) { return std::int64_t{value}; };
  PolyTable table;
  table.points = column(packing.beads, [](const Bead& b) { return Vec3(b.centre / um); });
  table.lines = column(packing.bridges, [](const Bridge& b) { return std::array<int, 2>{b.i, b.j}; });
  const auto of_beads = [&](const char* name, auto get) {
    table.point_data.emplace_back(name, column(packing.beads, get));
  };
  of_beads("bead_id", [](const Bead& b) { return b.id; });
  of_beads("diameter_um", [](const Bead& b) { return b.diameter / um; });
  of_beads("sigma_centre_um", [](const Bead& b) { return b.sigma_centre / um; });
  of_beads("sigma_diameter_um", [](const Bead& b) { return b.sigma_diameter / um; });
  of_beads("quality", [](const Bead& b) { return b.quality; });
  of_beads("boundary", [&](const Bead& b) { return flag(b.boundary); });
  const auto of_bridges = [&](const char* name, auto get) {
    table.line_data.emplace_back(name, column(packing.bridges, get));
  };
  of_bridges("gap_um", [](const Bridge& b) { return b.gap / um; });
  of_bridges("sigma_gap_um", [](const Bridge& b) { return b.sigma_gap / um; });
  of_bridges("probability", [](const Bridge& b) { return b.probability; });
  of_bridges("bridge_diameter_um", [](const Bridge& b) { return b.diameter / um; });
  of_bridges("sigma_bridge_diameter_um", [](const Bridge& b) { return b.sigma_diameter / um; });
  of_bridges("state", [](const Bridge& b) { return code_of(b.state); });
  table.text_fields = {{"format", "pendular packing"},
                       {"length_unit", "um"},
                       {"states", kStates},
                       {"provenance", to_json(packing.provenance).dump()}};
  table.number_fields = {{"format_version", kFormatVersion},
                         {"specimen_diameter_um", packing.specimen.diameter / um},
                         {"specimen_height_um", packing.specimen.height / um},
                         {"specimen_axis_x_um", packing.specimen.axis_x / um},
                         {"specimen_axis_y_um", packing.specimen.axis_y / um},
                         {"specimen_bottom_um", packing.specimen.bottom / um}};
  return table;
}

void write_packing(const fs::path& path, const Packing& packing) {
  write_polydata(path, to_polydata(packing));
}

Packing read_packing(const fs::path& path) {
  const PolyTable table = read_polydata(path);
  const double version = number_field(table, "format_version", path);
  if (!(version <= kFormatVersion))
    bad_input("{}: field data format_version: found {}, expected at most {}", path.string(), version,
              kFormatVersion);
  return {beads_of(table, path), bridges_of(table, path), specimen_of(table, path),
          provenance_of(table, path)};
}

}  // namespace pendular
