#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files.h"
#include "viz/viewer/specimen_view.h"

namespace pendular::viz {

/// A picture file (.png or .svg) and what it shows.
struct ReportPicture {
  fs::path file;
  std::string caption;
};

/// One figure of the table: "Linear modulus", "15.3 ± 0.2", "MPa". Where no row has a unit there is no such
/// column.
struct ReportRow {
  std::string quantity, value, unit;
};

/// Columns in which every cell starts as a number does are aligned right.
struct ReportTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as columns
};

struct ReportSection {
  std::string heading;
  std::string text;  ///< a paragraph; may be empty
  std::vector<ReportRow> rows;
  std::vector<ReportPicture> pictures;
  std::vector<ReportTable> tables = {};      ///< after the pictures
  std::vector<SpecimenView> specimens = {};  ///< before the pictures
};

struct Report {
  std::string title;
  std::string summary;  ///< in words; paragraphs end with line breaks
  std::vector<ReportSection> sections;
  nlohmann::ordered_json provenance;       ///< shown at the end; null: none
  std::vector<std::string> warnings = {};  ///< shown after the summary
  std::vector<ReportRow> figures = {};     ///< the few that the summary rests on, after both
};

/// Writes a report as one HTML page that needs nothing else and no network. A PNG is embedded as a smaller
/// JPEG, an SVG whole; either is a link to its file where that lies in the page's folder or below. Every text
/// is escaped. The page runs no script but that of its specimens, by a content security policy; without WebGL
/// 2 it says in one line that they cannot be turned. BadInput where a picture cannot be read.
void write_report(const fs::path& path, const Report& report);

}  // namespace pendular::viz
