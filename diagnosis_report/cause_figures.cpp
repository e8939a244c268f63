#include "diagnosis_report/cause_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "diagnosis/words.h"
#include "diagnosis_report/explanations.h"
#include "diagnosis_report/tables.h"
#include "viz/matrix_plot.h"
#include "viz/row_plot.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;
using viz::RowSeries;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kSeparable = 9.0;      // squared distance from which two effects can be told apart
constexpr double kLargestShown = 10.0;  // standard deviations at the end of the colours

std::vector<bool> suspects(const Diagnosis& d) {
  std::vector<bool> marked;
  for (const std::string& effect : d.effects) marked.push_back(is_suspect(d, effect));
  return marked;
}

std::vector<std::string> effect_names(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const std::string& effect : d.effects) names.push_back(diagnosis::plain_name(effect));
  return names;
}

std::vector<std::string> feature_labels(const Diagnosis& d) {
  std::vector<std::string> labels;
  for (const auto& row : d.gap.rows) labels.push_back(feature_label(row.observed));
  return labels;
}

std::vector<std::string> feature_names(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const auto& row : d.gap.rows)
    names.push_back(fmt::format("{}: {}", row.observed.observation, row.observed.name));
  return names;
}

/// Values of a matrix row by row.
std::vector<double> row_by_row(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  return values;
}

/// `values`: row by row, a row for each effect.
Table matrix_table(const std::string& name, const std::vector<std::string>& effects,
                   const std::vector<std::string>& columns, const std::vector<double>& values) {
  Table table{name, {"effect"}, {}};
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  for (std::size_t row = 0; row < effects.size(); ++row) {
    table.rows.push_back({effects[row]});
    for (std::size_t k = 0; k < columns.size(); ++k)
      table.rows.back().emplace_back(values[row * columns.size() + k]);
  }
  return table;
}

std::string probability_label(double p) {
  return p < 0.0005 ? "<0.001" : fmt::format("{:.3f}", p);
}

/// The magnitude of an effect with all features together; NaN where it is no explanation by itself.
diagnosis::Magnitude joint(const Diagnosis& d, const std::string& effect) {
  for (const auto& e : d.explanations)
    if (e.id == effect && !e.magnitudes.empty()) return e.magnitudes.front();
  return {kNone, {kNone, kNone}};
}

std::string unit_of(const Diagnosis& d, const std::string& effect) {
  for (const auto& e : d.explanations)
    if (e.id == effect && !e.units.empty()) return e.units.front();
  return "";
}

/// Suspected effects of which groups of features have something to say.
std::vector<std::string> grouped_effects(const Diagnosis& d) {
  std::vector<std::string> effects;
  for (const auto& group : d.groups)
    if (is_suspect(d, group.effect) &&
        std::find(effects.begin(), effects.end(), group.effect) == effects.end())
      effects.push_back(group.effect);
  return effects;
}

Drawn magnitude_figure(const Diagnosis& d, const std::string& effect) {
  viz::RowPlot plot;
  RowSeries series;
  series.look = RowSeries::Look::points;
  Table table{"magnitude_" + effect, {"observation", "magnitude", "low_90", "high_90", "unit"}, {}};
  const std::string unit = unit_of(d, effect);
  const SpeltUnit drawn = spelt_unit(unit, 1.0);
  const auto in_drawn = [&](const std::pair<double, double>& ends) {
    return std::pair(drawn.factor * ends.first, drawn.factor * ends.second);
  };
  const auto add = [&](const std::string& name, const diagnosis::Magnitude& m, bool together) {
    plot.labels.push_back(name);
    plot.marked.push_back(together);
    series.values.push_back(drawn.factor * m.mean);
    series.intervals.push_back(in_drawn(m.interval_90));
    table.rows.push_back({name, m.mean, m.interval_90.first, m.interval_90.second, unit});
  };
  for (const auto& group : d.groups)
    if (group.effect == effect) add(group.group, group.magnitude, false);
  const auto together = joint(d, effect);
  add("all together", together, true);
  std::vector<double> guides;
  if (const auto [low, high] = in_drawn(together.interval_90); std::isfinite(together.mean))
    guides = {low, high};
  const std::string name = diagnosis::plain_name(effect);
  const std::string in = drawn.after.starts_with(' ') ? drawn.after.substr(1) : drawn.after;
  plot.panels = {{in.empty() ? name : fmt::format("{} ({})", name, in), {series}, guides}};
  return {viz::row_figure(plot),
          fmt::format(
              "{}: the magnitude that each observation asks for by itself, with 90 % intervals, and all "
              "together (dashed). A cause is asked for alike by all; what only makes up for another is not.",
              diagnosis::name_and_id(effect)),
          table};
}

}  // namespace

std::optional<Drawn> hypothesis_figure(const Diagnosis& d) {
  if (d.explanations.empty()) return {};
  const Shown shown = shown_of(d);
  viz::RowPlot plot;
  RowSeries probability;
  std::vector<std::string> notes;
  const auto add = [&](const std::string& label, double p, bool marked) {
    plot.labels.push_back(label);
    plot.marked.push_back(marked);
    probability.values.push_back(p);
    notes.push_back(probability_label(p));
  };
  for (const auto& e : shown.explanations)
    add(diagnosis::plain_name(e.id) + (e.excluded ? " (excluded)" : ""), e.probability,
        in_ambiguity_set(d, e.id));
  if (shown.other_pairs > 0)
    add(fmt::format("{} other pairs together", shown.other_pairs), shown.other_probability, false);
  plot.panels = {{"probability", {probability}, {}, notes}};
  return Drawn{viz::row_figure(plot),
               "Probability of every explanation, given the gap and what is believed of the specimens. Bold "
               "type and orange: those that cannot be told apart with these observations.",
               hypothesis_table(d)};
}

std::optional<Drawn> signature_figure(const Diagnosis& d) {
  if (d.signatures.size() == 0) return {};
  viz::Matrix map;
  map.rows = effect_names(d), map.columns = feature_labels(d);
  map.values = row_by_row(d.signatures);
  map.marked_rows = suspects(d);
  map.quantity = std::string("change/noise");
  map.limit = kLargestShown;
  return Drawn{
      viz::matrix_figure(map),
      fmt::format("Signatures: what each effect at its typical magnitude does to each feature of the "
                  "simulation, over the feature's noise; colours end at {:g}. Bold: the effects that "
                  "cannot be told apart with these observations.",
                  kLargestShown),
      matrix_table("signatures", d.effects, feature_names(d), map.values)};
}

std::optional<Drawn> separation_figure(const Diagnosis& d) {
  if (d.separation.size() == 0) return {};
  viz::Matrix map;
  map.rows = map.columns = effect_names(d);
  map.columns.push_back("no effect");
  std::vector<std::string> ids = d.effects;
  ids.push_back(map.columns.back());
  const auto squared = row_by_row(d.separation);
  for (std::size_t k = 0; k < squared.size(); ++k) {
    const bool itself = k % map.columns.size() == k / map.columns.size();
    map.values.push_back(itself ? kNone : std::sqrt(std::max(0.0, squared[k])));
    map.framed.push_back(!itself && squared[k] < kSeparable);
  }
  map.marked_rows = suspects(d);
  map.quantity = "distance";
  map.about_zero = false;
  map.limit = kLargestShown;
  return Drawn{
      viz::matrix_figure(map),
      fmt::format("How far each effect at its typical magnitude (row) is from the nearest that another "
                  "effect can do (column), and from no effect, in standard deviations of the noise; "
                  "colours end at {:g}. Framed: below three, not to be told apart here, or in the last "
                  "column not to be seen. The table has the squares.",
                  kLargestShown),
      matrix_table("separation", d.effects, ids, squared)};
}

std::vector<Drawn> magnitude_figures(const Diagnosis& d) {
  std::vector<Drawn> figures;
  for (const std::string& effect : grouped_effects(d)) figures.push_back(magnitude_figure(d, effect));
  return figures;
}

std::optional<Drawn> pull_figure(const Diagnosis& d) {
  if (d.pulls.empty()) return {};
  viz::RowPlot plot;
  RowSeries pull, impact;
  pull.look = RowSeries::Look::points;
  Table table{"pulls", {"key", "sigma", "pull", "spread", "impact"}, {}};
  for (const auto& p : d.pulls) {
    plot.labels.push_back(p.key);
    pull.values.push_back(p.pull);
    pull.intervals.emplace_back(p.pull - p.spread, p.pull + p.spread);
    impact.values.push_back(p.impact);
    table.rows.push_back({p.key, p.sigma, p.pull, p.spread, p.impact});
  }
  plot.panels = {{"pull (stated sd)", {pull}, {-1.0, 1.0}, {}, -1.2, 1.2}, {"impact (noise)", {impact}}};
  return Drawn{
      viz::row_figure(plot),
      "Believed inputs under the best explanation. Left: best value less believed one, in stated "
      "standard deviations, with what remains of the uncertainty; beyond the dashed lines an input is "
      "asked to be further off than was stated. Right: what one standard deviation does to the "
      "features, root mean square over their noise.",
      table};
}

std::optional<Drawn> chi_squared_figure(const Diagnosis& d) {
  const Shown shown = shown_of(d);
  viz::RowPlot plot;
  RowSeries chi_squared;
  Table table{"goodness", {"id", "misfit"}, {}};
  for (const auto& e : shown.explanations) {
    if (e.id == "unknown" || !(e.reduced_chi_squared > 0.0)) continue;  // zero: it was not simulated
    plot.labels.push_back(diagnosis::plain_name(e.id));
    plot.marked.push_back(in_ambiguity_set(d, e.id));
    chi_squared.values.push_back(e.reduced_chi_squared);
    table.rows.push_back({e.id, e.reduced_chi_squared});
  }
  if (plot.labels.empty()) return {};
  plot.panels = {{"reduced chi-squared", {chi_squared}, {1.0}}};
  return Drawn{
      viz::row_figure(plot),
      fmt::format(
          "Misfit: χ² over the number of directions that responses span, of each explanation at its best "
          "magnitude; noise alone gives about one (dashed). The best explanation's p-value is {}.",
          rounded(d.p_value)),
      table};
}

}  // namespace pendular::diagnosis_report
