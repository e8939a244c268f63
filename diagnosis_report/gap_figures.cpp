#include "diagnosis_report/gap_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/words.h"
#include "diagnosis_report/explanations.h"
#include "diagnosis_report/tables.h"
#include "viz/matrix_plot.h"
#include "viz/row_plot.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Feature;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestShown = 10.0;  // |z| at the end of the colours

std::vector<std::string> observations_of(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const auto& row : d.gap.rows)
    if (std::find(names.begin(), names.end(), row.observed.observation) == names.end())
      names.push_back(row.observed.observation);
  return names;
}

/// Middle of the strain that a feature is read from; what has no strain comes last.
double place(const Feature& feature) {
  if (feature.strain_to <= 0.0) return std::numeric_limits<double>::infinity();
  return 0.5 * (feature.strain_from + feature.strain_to);
}

/// Names of features along the strain axis, by where each first is.
std::vector<std::string> features_along_strain(const Diagnosis& d) {
  std::vector<std::pair<double, std::string>> found;
  for (const auto& row : d.gap.rows) {
    const auto same = [&](const auto& one) { return one.second == row.observed.name; };
    const auto at = std::find_if(found.begin(), found.end(), same);
    if (at == found.end())
      found.emplace_back(place(row.observed), row.observed.name);
    else
      at->first = std::min(at->first, place(row.observed));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (const auto& [strain, name] : found) names.push_back(name);
  return names;
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

Table map_table(const viz::Matrix& map) {
  Table table{"gap_map", {"observation"}, {}};
  table.columns.insert(table.columns.end(), map.columns.begin(), map.columns.end());
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    table.rows.push_back({map.rows[row]});
    for (std::size_t k = 0; k < map.columns.size(); ++k)
      table.rows.back().emplace_back(map.values[row * map.columns.size() + k]);
  }
  return table;
}

Drawn map_figure(const Diagnosis& d) {
  viz::Matrix map;
  map.rows = observations_of(d), map.columns = features_along_strain(d);
  map.values.assign(map.rows.size() * map.columns.size(), kNone);
  map.framed.assign(map.values.size(), false);
  map.quantity = std::string("z");  // not from the literal: GCC 12 warns (bug 105651)
  double largest = 0.0;
  for (const auto& row : d.gap.rows) {
    const std::size_t at = index_of(map.rows, row.observed.observation) * map.columns.size() +
                           index_of(map.columns, row.observed.name);
    map.values[at] = row.z;
    map.framed[at] = row.significant;
    if (std::isfinite(row.z)) largest = std::max(largest, std::fabs(row.z));
  }
  map.limit = std::clamp(largest, 3.0, kLargestShown);
  const Table table = map_table(map);
  for (std::string& name : map.columns) name = diagnosis::name_in_words(name);
  return {
      viz::matrix_figure(map),
      fmt::format("Where simulation and experiment part: z of each feature, simulated less observed over "
                  "the noise of the difference; red where the simulation is too high, blue where it is "
                  "too low, framed where significant with all features taken together (|z| above {:.1f}). "
                  "Features in the order of the strain they are read from, those without strain last.",
                  d.gap.threshold),
      table};
}

std::string label_of(const Feature& feature) {
  std::string name = feature_label(feature);
  if (feature.strain_to <= 0.0) return name;
  return fmt::format("{}, {:.2g}\u2013{:.2g} %", name, 100.0 * feature.strain_from,
                     100.0 * feature.strain_to);
}

Drawn feature_figure(const Diagnosis& d) {
  viz::RowPlot plot;
  viz::RowSeries z, share;
  for (const auto& row : d.gap.rows) {
    plot.labels.push_back(label_of(row.observed));
    plot.marked.push_back(row.significant);
    z.values.push_back(row.z);
    share.values.push_back(100.0 * row.share);
  }
  plot.panels = {{"z", {z}, {-d.gap.threshold, d.gap.threshold}}, {"share of the gap (%)", {share}}};
  return {viz::row_figure(plot),
          "Every feature with the platen strain that it is read from: z, with the bounds of significance "
          "(dashed; significant ones in bold type and orange), and the share of the gap that goes when the "
          "feature is left out.",
          gap_table(d)};
}

}  // namespace

std::vector<Drawn> gap_figures(const Diagnosis& d) {
  std::vector<Drawn> figures;
  if (d.gap.rows.empty()) return figures;
  figures.push_back(map_figure(d));
  figures.push_back(feature_figure(d));
  return figures;
}

}  // namespace pendular::diagnosis_report
