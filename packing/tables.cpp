#include "packing/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>

#include "base/csv.h"
#include "base/error.h"
#include "base/number_cell.h"
#include "packing/check.h"

namespace pendular {
namespace {

constexpr double um = 1e-6;

/// An optional column; `missing` where it or a cell is not there.
std::vector<double> optional_numbers(const CsvTable& table, const std::string& column, double missing) {
  if (!table.has(column)) return std::vector<double>(table.rows(), missing);
  std::vector<double> values = table.numbers(column, true);
  std::replace_if(
      values.begin(), values.end(), [](double v) { return std::isnan(v); }, missing);
  return values;
}

void require_not_negative(const CsvTable& table, const std::string& column,
                          const std::vector<double>& values) {
  for (std::size_t row = 0; row < values.size(); ++row)
    if (values[row] < 0.0)
      bad_input("{}: column {}: found {}, expected none below 0", table.where(row), column, values[row]);
}

std::vector<double> optional_sigmas(const CsvTable& table, const std::string& column) {
  std::vector<double> values = optional_numbers(table, column, 0.0);
  require_not_negative(table, column, values);
  return values;
}

/// BadInput naming both lines where an id is found twice.
void require_unique(const CsvTable& table, const std::vector<long long>& ids) {
  std::unordered_map<std::int64_t, std::size_t> rows;
  for (std::size_t row = 0; row < ids.size(); ++row) {
    const auto [first, is_new] = rows.emplace(ids[row], row);
    if (!is_new)
      bad_input("{}: column bead_id: found {} again (first at {}), expected each id once", table.where(row),
                ids[row], table.where(first->second));
  }
}

BridgeState state_at(const CsvTable& table, std::size_t row) {
  if (!table.has("state") || table.texts("state")[row].empty()) return BridgeState::bridge;
  try {
    return bridge_state(table.texts("state")[row]);
  } catch (const BadInput& error) {
    bad_input("{}: column state: {}", table.where(row), error.what());
  }
}

}  // namespace

void write_beads(const fs::path& path, const std::vector<Bead>& beads, const Provenance& provenance) {
  std::string text = to_comment(provenance);
  text += "bead_id,x_um,y_um,z_um,diameter_um,sigma_centre_um,sigma_diameter_um,quality,boundary\n";
  for (const auto& b : beads)
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6g},{}\n", b.id,
                   NumberCell{b.centre.x() / um}, NumberCell{b.centre.y() / um},
                   NumberCell{b.centre.z() / um}, NumberCell{b.diameter / um},
                   NumberCell{b.sigma_centre / um}, NumberCell{b.sigma_diameter / um}, NumberCell{b.quality},
                   b.boundary ? 1 : 0);
  write_text(path, text);
}

std::vector<Bead> read_beads(const fs::path& path) {
  const CsvTable table = read_csv(path, {"bead_id", "x_um", "y_um", "z_um", "diameter_um"},
                                  {"sigma_centre_um", "sigma_diameter_um", "quality", "boundary"});
  const auto ids = table.integers("bead_id");
  const auto x = table.numbers("x_um"), y = table.numbers("y_um"), z = table.numbers("z_um");
  const auto diameter = table.numbers("diameter_um");
  const auto sigma_centre = optional_sigmas(table, "sigma_centre_um");
  const auto sigma_diameter = optional_sigmas(table, "sigma_diameter_um");
  const auto quality = optional_numbers(table, "quality", 1.0);
  const auto boundary = optional_numbers(table, "boundary", 0.0);
  require_unique(table, ids);
  std::vector<Bead> beads(table.rows());
  for (std::size_t row = 0; row < beads.size(); ++row) {
    if (diameter[row] <= 0.0)
      bad_input("{}: column diameter_um: found {}, expected a positive diameter", table.where(row),
                diameter[row]);
    beads[row] = {ids[row],
                  um * Vec3(x[row], y[row], z[row]),
                  um * diameter[row],
                  um * sigma_centre[row],
                  um * sigma_diameter[row],
                  quality[row],
                  boundary[row] != 0.0};
  }
  check_beads(beads, path.string());
  return beads;
}

void write_bridges(const fs::path& path, const std::vector<Bead>& beads, const std::vector<Bridge>& bridges,
                   const Provenance& provenance) {
  std::string text = to_comment(provenance);
  text += "bead_i,bead_j,gap_um,sigma_gap_um,probability,bridge_diameter_um,sigma_bridge_diameter_um,state\n";
  for (const auto& b : bridges)
    fmt::format_to(std::back_inserter(text), "{},{},{:.6f},{:.6f},{:.6g},{:.6f},{:.6f},{}\n",
                   beads.at(static_cast<std::size_t>(b.i)).id, beads.at(static_cast<std::size_t>(b.j)).id,
                   NumberCell{b.gap / um}, NumberCell{b.sigma_gap / um}, NumberCell{b.probability},
                   NumberCell{b.diameter / um}, NumberCell{b.sigma_diameter / um}, to_string(b.state));
  write_text(path, text);
}

std::vector<Bridge> read_bridges(const fs::path& path, const std::vector<Bead>& beads) {
  const CsvTable table = read_csv(
      path, {"bead_i", "bead_j"},
      {"gap_um", "sigma_gap_um", "probability", "bridge_diameter_um", "sigma_bridge_diameter_um", "state"});
  std::unordered_map<std::int64_t, int> index;
  for (std::size_t k = 0; k < beads.size(); ++k) index.emplace(beads[k].id, static_cast<int>(k));
  const auto ids_i = table.integers("bead_i"), ids_j = table.integers("bead_j");
  const auto gap_um = optional_numbers(table, "gap_um", std::nan(""));
  const auto sigma_gap = optional_sigmas(table, "sigma_gap_um");
  const auto probability = optional_numbers(table, "probability", 1.0);
  const auto diameter = optional_sigmas(table, "bridge_diameter_um");
  const auto sigma_diameter = optional_sigmas(table, "sigma_bridge_diameter_um");

  const auto find = [&](std::size_t row, const char* column, std::int64_t id) {
    const auto found = index.find(id);
    if (found == index.end())
      bad_input("{}: column {}: found bead {}, expected one of the beads", table.where(row), column, id);
    return found->second;
  };
  std::map<std::pair<int, int>, std::size_t> seen;
  std::vector<Bridge> bridges;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto [i, j] = std::minmax({find(row, "bead_i", ids_i[row]), find(row, "bead_j", ids_j[row])});
    if (i == j)
      bad_input("{}: found bead {} joined to itself, expected two beads", table.where(row), ids_i[row]);
    const auto [first, is_new] = seen.emplace(std::pair(i, j), row);
    if (!is_new)
      bad_input("{}: found beads {} and {} again (first at {}), expected each pair once", table.where(row),
                ids_i[row], ids_j[row], table.where(first->second));
    const double separation = gap(beads[static_cast<std::size_t>(i)], beads[static_cast<std::size_t>(j)]);
    bridges.push_back({i, j, std::isnan(gap_um[row]) ? separation : um * gap_um[row], um * sigma_gap[row],
                       probability[row], um * diameter[row], um * sigma_diameter[row], state_at(table, row)});
  }
  std::sort(bridges.begin(), bridges.end(),
            [](const Bridge& a, const Bridge& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return bridges;
}

}  // namespace pendular
