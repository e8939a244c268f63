#include <fmt/format.h>

#include <algorithm>

#include "micromechanics/stiffness.h"
#include "reproduction/sections.h"

namespace pendular::reproduction {
namespace {

/// The columns that tell how a point behaves, in units in which bonds of another stiffness give the same.
const std::vector<std::string> kBehaviour = {
    "runs", "Z", "E/E_p", "E D/kn", "slope at 2–3 %, D/kn", "linear limit, %", "peak at, %"};

std::vector<std::string> behaviour_of(const Point& point) {
  const Sample& sample = point.sample;
  Sample mean = sample;
  mean.bridges.stiffness = StiffnessOf::one;
  const double unit = micromechanics::bond_stiffness(mean).normal / sample.beads.diameter;
  const Spread e = spread_of(point, modulus);
  return {std::to_string(point.runs.size()),
          in_words(spread_of(point, coordination_number), 1.0, 2),
          in_words(e, sample.bridges.youngs_modulus),
          in_words(e, unit, 2),
          in_words(spread_of(point, slope_at_fixed_strain), unit, 2),
          in_words(spread_of(point, linear_limit), 0.01, 2),
          in_words(spread_of(point, peak_strain), 0.01, 2)};
}

std::vector<std::string> row_of(const std::string& words, const Point& point) {
  std::vector<std::string> row = {words};
  const auto cells = behaviour_of(point);
  row.insert(row.end(), cells.begin(), cells.end());
  return row;
}

Table table_of(const std::string& first_column) {
  Table table{{first_column}, {}};
  table.columns.insert(table.columns.end(), kBehaviour.begin(), kBehaviour.end());
  return table;
}

/// The keys in which a sample differs from another, with their values.
std::string difference(const Sample& from, const Sample& to) {
  const auto before = sample_settings(from), after = sample_settings(to);
  std::string words;
  for (const auto& setting : after)
    if (std::find(before.begin(), before.end(), setting) == before.end())
      words += (words.empty() ? "" : ", ") + setting.first + " = " + sweep::to_string(setting.second);
  return words;
}

/// The paper's remark that the stiffness of the glass does not matter, at a point that changes it.
void compare_glass(const Point& base, const Point& point, Section& section) {
  const double ratio = point.sample.contact.stiffness_ratio, usual = base.sample.contact.stiffness_ratio;
  if (ratio == usual) return;
  const double change = spread_of(point, modulus).mean / spread_of(base, modulus).mean;
  section.comparisons.push_back({fmt::format("E at k_glass = {:g} kn over {:g} kn", ratio, usual), "robust",
                                 fmt::format("{:.2f}", change), within(change, 0.9, 1.1),
                                 "Touching glass carries much of the load here, so its stiffness counts."});
}

}  // namespace

std::optional<Section> size_section(const Point& whole, std::span<const Point> series) {
  const auto small = std::find_if(series.begin(), series.end(), [&](const Point& point) {
    return point.sample.bridges.youngs_modulus == whole.sample.bridges.youngs_modulus &&
           point.sample.bridges.gap == whole.sample.bridges.gap;
  });
  if (small == series.end()) return std::nullopt;
  Section section{
      "Whole specimen and smaller cylinder",
      "The series below are made with a smaller cylinder of about the same Z, to be affordable. Beside "
      "the whole specimen, in units of kn/D:"};
  section.table = table_of("cylinder, mm");
  for (const Point* point : {&whole, &*small})
    section.table->rows.push_back(row_of(fmt::format("{:.2f} × {:.2f}", 1e3 * point->sample.specimen.diameter,
                                                     1e3 * point->sample.specimen.height),
                                         *point));
  return section;
}

Section sensitivity_section(const std::vector<Point>& points) {
  Section section{
      "What E and its limit hang on",
      "The smaller cylinder with one choice changed at a time. kn is that of the mean bridge. With G in "
      "proportion to E_p all is the same in model units; with one G it is not."};
  section.table = table_of("changed");
  for (const Point& point : points) {
    const std::string words = difference(points.front().sample, point.sample);
    section.table->rows.push_back(row_of(words.empty() ? "nothing" : words, point));
    compare_glass(points.front(), point, section);
  }
  return section;
}

}  // namespace pendular::reproduction
