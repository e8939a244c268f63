#pragma once

#include <string>
#include <variant>
#include <vector>

#include "viz/report.h"

namespace pendular::diagnosis_report {

/// A number, NaN where there is none, or words.
using Cell = std::variant<double, std::string>;

/// What is written as a CSV file and, rounded, into the page.
struct Table {
  std::string name;  ///< of its file, without ".csv"
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< as many cells as columns
};

/// Header line and rows.
std::string to_csv(const Table& table);

/// Numbers with three significant digits, columns' underscores as spaces.
viz::ReportTable to_report(const Table& table, const std::string& caption);

}  // namespace pendular::diagnosis_report
