#include "diagnosis_report/outcome_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "diagnosis/words.h"
#include "diagnosis_report/tables.h"
#include "viz/row_plot.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Shrinkage;
using viz::RowSeries;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One row of the figure.
struct Row {
  std::string name;
  Shrinkage shrinkage;
};

/// What a control comes to on the withheld observations; its interval is not known.
Shrinkage control(const Shrinkage& withheld, double fraction) {
  return {
      withheld.before, withheld.before * (1.0 - fraction), fraction, {kNone, kNone}, withheld.observations};
}

std::vector<Row> rows_of(const Diagnosis& d) {
  std::vector<Row> rows;
  if (!d.fitted.observations.empty()) rows.push_back({"fitted", d.fitted});
  if (d.withheld.observations.empty()) return rows;
  rows.push_back({"withheld", d.withheld});
  if (d.withheld.nothing_to_close) return rows;
  rows.push_back({"control: only the polymer's modulus retuned", control(d.withheld, d.retuned)});
  if (!d.wrong_effect.empty())
    rows.push_back(
        {"control: a wrong effect, " + diagnosis::plain_name(d.wrong_effect), control(d.withheld, d.wrong)});
  return rows;
}

}  // namespace

std::optional<Drawn> shrinkage_figure(const Diagnosis& d) {
  const auto rows = rows_of(d);
  if (rows.empty()) return {};
  viz::RowPlot plot;
  RowSeries before{"as believed", {}}, after{"with what was added", {}}, closed;
  closed.look = RowSeries::Look::points;
  Table table{"shrinkage", {"data", "before", "after", "fraction", "low_90", "high_90", "observations"}, {}};
  for (const auto& [name, s] : rows) {
    plot.labels.push_back(name);
    plot.marked.push_back(name == "withheld");
    before.values.push_back(s.before);
    after.values.push_back(s.after);
    closed.values.push_back(s.nothing_to_close ? kNone : 100.0 * s.fraction);
    closed.intervals.emplace_back(100.0 * s.interval_90.first, 100.0 * s.interval_90.second);
    table.rows.push_back({name, s.before, s.after, s.fraction, s.interval_90.first, s.interval_90.second,
                          fmt::format("{}", fmt::join(s.observations, "; "))});
  }
  plot.panels = {{"excess gap (noise)", {before, after}},
                 {"share of the gap closed (%)", {closed}, {100.0}, {}, 0.0, 105.0}};
  return Drawn{viz::row_figure(plot),
               "How far the gap shrinks. Left: the gap beyond noise before and after. Right: the share of it "
               "that is closed, with its 90 % interval. Withheld observations took no part in choosing "
               "anything; the controls show what closes without the right cause.",
               table};
}

std::optional<Drawn> next_figure(const diagnosis::NextSteps& steps) {
  if (steps.now.cases == 0) return {};
  viz::RowPlot plot;
  RowSeries sizes, settled, cost;
  std::vector<std::string> notes;
  const auto add = [&](const std::string& name, const diagnosis::Outlook& outlook, double price) {
    plot.labels.push_back(name);
    plot.marked.push_back(price == 0.0);
    sizes.values.push_back(outlook.set_size);
    settled.values.push_back(100.0 * outlook.settled);
    cost.values.push_back(price);
    notes.push_back(fmt::format("{:.1f}", outlook.set_size));
  };
  add("nothing more", steps.now, 0.0);
  for (const auto& next : steps.experiments)
    if (next.outlook.cases > 0) add(next.observation, next.outlook, next.cost);
  if (plot.labels.size() == 1) return {};
  plot.panels = {{"expected size of the set", {sizes}, {1.0}, notes},
                 {"settled by it (%)", {settled}, {}, {}, 0.0, 100.0},
                 {"cost (compression tests)", {cost}}};
  return Drawn{
      viz::row_figure(plot),
      "What to measure next, best value for its cost first: explanations that are expected to remain, "
      "and how probable it is that the right one remains alone.",
      next_table(steps)};
}

}  // namespace pendular::diagnosis_report
