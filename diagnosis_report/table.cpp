#include "diagnosis_report/table.h"

#include <algorithm>

#include "base/csv.h"
#include "base/quantity.h"

namespace pendular::diagnosis_report {
namespace {

std::string to_text(const std::string& text) {
  return csv_cell(text);
}

std::string to_text(const Cell& cell) {
  return std::visit([](const auto& value) { return csv_cell(value); }, cell);
}

template <typename Cells>
std::string line_of(const Cells& cells) {
  std::string line;
  for (const auto& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    line += to_text(cell);
  }
  return line + '\n';
}

std::string in_page(const Cell& cell) {
  const double* number = std::get_if<double>(&cell);
  return number ? rounded(*number) : std::get<std::string>(cell);
}

}  // namespace

std::string to_csv(const Table& table) {
  std::string text = line_of(table.columns);
  for (const auto& row : table.rows) text += line_of(row);
  return text;
}

viz::ReportTable to_report(const Table& table, const std::string& caption) {
  viz::ReportTable out{caption, table.columns, {}};
  for (std::string& column : out.columns) std::replace(column.begin(), column.end(), '_', ' ');
  for (const auto& row : table.rows) {
    out.rows.emplace_back();
    for (const Cell& cell : row) out.rows.back().push_back(in_page(cell));
  }
  return out;
}

}  // namespace pendular::diagnosis_report
