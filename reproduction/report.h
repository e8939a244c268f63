#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/provenance.h"
#include "viz/figure.h"

namespace pendular::reproduction {

/// A number of the paper beside ours.
struct Comparison {
  std::string quantity, paper, ours;
  bool matched = false;
  std::string why = {};  ///< a sentence for where it is not
};

/// What counts as found: a value within [low, high].
bool within(double value, double low, double high);

/// A picture and the table behind it, by file name within the report's folder.
struct Figure {
  std::string picture, table, caption;
};

/// A table of our own numbers.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct Section {
  std::string heading, text;
  std::vector<Comparison> comparisons = {};
  std::optional<Table> table = {};
  std::vector<Figure> figures = {};
};

/// report.md as Markdown text: sections with their comparisons, tables and figures, then what was not
/// matched and why.
std::string to_markdown(const std::vector<Section>& sections, const Provenance& provenance);

/// Where figures go.
struct Desk {
  fs::path out;
  const Provenance& provenance;

  /// Writes NAME.png, NAME.pdf and NAME.csv (header line, then rows), and gives the figure.
  Figure keep(const std::string& name, const viz::Figure& chart, const std::string& csv,
              const std::string& caption) const;
};

}  // namespace pendular::reproduction
