#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular {

/// Columns of a CSV file (one header line, comma, `.` decimals, `#` comments), read by name.
class CsvTable {
 public:
  std::size_t rows() const { return lines_.size(); }
  bool has(const std::string& column) const { return cells_.count(column) != 0; }

  /// A column as numbers; BadInput naming file, line and column for a cell that is none, or one that is not
  /// in the column's range (base/columns.h). An empty cell is NaN where `empty_is_nan`.
  std::vector<double> numbers(const std::string& column, bool empty_is_nan = false) const;
  std::vector<long long> integers(const std::string& column) const;
  const std::vector<std::string>& texts(const std::string& column) const { return cells_.at(column); }

  /// "file:line" of a row, for error messages.
  std::string where(std::size_t row) const;

 private:
  friend CsvTable read_csv(const fs::path&, const std::vector<std::string>&, const std::vector<std::string>&);
  fs::path path_;
  std::vector<std::size_t> lines_;
  std::map<std::string, std::vector<std::string>> cells_;
};

/// Reads the named columns, at most 24. BadInput where a required one is missing; other columns are ignored.
CsvTable read_csv(const fs::path& path, const std::vector<std::string>& required,
                  const std::vector<std::string>& optional = {});

/// A cell of a table that is written: a number as short as it reads back the same, empty where it is not
/// finite; a text quoted where it must be, its line breaks made spaces.
std::string csv_cell(double value);
std::string csv_cell(double value, int digits);  ///< so many significant ones at most
std::string csv_cell(const std::string& text);

}  // namespace pendular
