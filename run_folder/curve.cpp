#include "run_folder/curve.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/csv.h"

namespace pendular {
namespace {

const CurveColumn& column_of(double CurveRow::*field) {
  const auto& all = curve_columns();
  return *std::find_if(all.begin(), all.end(), [&](const CurveColumn& one) { return one.field == field; });
}

}  // namespace

const std::vector<CurveColumn>& curve_columns() {
  static const std::vector<CurveColumn> columns = {
      {"strain", &CurveRow::strain, 9, false, "engineering strain from the travel of the platen"},
      {"stress_pa", &CurveRow::stress, 9, false, "force on the fixed platen over the initial section"},
      {"stress_bottom_pa", &CurveRow::stress_bottom, 9, false, "the same on the moving platen"},
      {"broken_bonds", &CurveRow::broken_bonds, 0, false, "since the start"},
      {"kinetic_energy_j", &CurveRow::kinetic, 9, false, "at the row's end"},
      {"elastic_energy_j", &CurveRow::elastic, 9, false, "at the row's end"},
      {"platen_work_j", &CurveRow::work, 9, false, "done by the platens since the start"},
      {"damped_j", &CurveRow::damped, 9, false, "taken by dashpots since the start"},
      {"slipped_j", &CurveRow::slipped, 9, false, "taken by friction since the start"},
      {"released_by_breaking_j", &CurveRow::released, 9, false, "held by bonds when they broke"},
      {"bonds_per_bead", &CurveRow::coordination, 6, false, "standing bonds per bead"},
      {"lateral_strain", &CurveRow::lateral_strain, 9, true, "at mid-height, expansion positive"},
      {"inertial_number", &CurveRow::inertial_number, 6, true, "empty without stress"},
      {"unbalanced_force", &CurveRow::unbalanced_force, 6, true,
       "mean net force on a bead over the mean force of a pair"},
      {"halted_j", &CurveRow::halted, 9, false, "taken out by bringing beads to rest, in quasi-static tests"},
  };
  return columns;
}

void write_curve(const fs::path& path, const std::vector<CurveRow>& rows, const Provenance& provenance) {
  std::string text = to_comment(provenance);
  const char* between = "";
  for (const auto& column : curve_columns()) text += between + column.name, between = ",";
  text += '\n';
  for (const auto& row : rows) {
    between = "";
    for (const auto& column : curve_columns()) {
      const double value = row.*column.field;
      text += between + (column.digits > 0 ? csv_cell(value, column.digits) : fmt::format("{:.0f}", value));
      between = ",";
    }
    text += '\n';
  }
  write_text(path, text);
}

std::vector<CurveRow> read_curve(const fs::path& path, const std::vector<double CurveRow::*>& wanted) {
  std::vector<std::string> names;
  for (const auto field : wanted) names.push_back(column_of(field).name);
  const CsvTable table = read_csv(path, names);
  std::vector<CurveRow> rows(table.rows());
  for (const auto field : wanted) {
    const CurveColumn& column = column_of(field);
    const auto values = table.numbers(column.name, column.may_be_empty);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].*field = values[k];
  }
  return rows;
}

}  // namespace pendular
