#include "viz/pipette_plot.h"

#include <algorithm>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

using Values = std::vector<double>;

constexpr Colour kBlue{31, 90, 165}, kGrey{130, 130, 130}, kRed{190, 40, 30}, kOrange{215, 120, 30};
constexpr Area kArea{0.12, 0.125, 0.84, 0.845};

void add_branch(Chart& chart, const Sheet& sheet, const ForceBranch& branch, Colour points, Colour line) {
  if (branch.force_un.empty()) return;
  Points measured;
  for (std::size_t k = 0; k < branch.force_un.size(); ++k)
    measured.emplace_back(branch.displacement_um[k], branch.force_un[k]);
  chart.add_points(measured, points, sheet.scaled(12), branch.label);
  if (!branch.line) return;
  const auto& l = *branch.line;
  chart.add_line(
      {{l.first_um, l.intercept + l.slope * l.first_um}, {l.last_um, l.intercept + l.slope * l.last_um}},
      {line, sheet.scaled(5)}, l.label);
}

/// The range of both branches' values and zero, with a little room.
std::pair<double, double> range_of(const Values& a, const Values& b) {
  double low = 0.0, high = 0.0;
  for (const Values* values : {&a, &b})
    for (double v : *values) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  const double room = high > low ? 0.06 * (high - low) : 1.0;
  return {low - room, high + room};
}

}  // namespace

Figure force_figure(const ForceBranch& loading, const ForceBranch& unloading, PictureSize size) {
  Sheet sheet(size);
  const auto [left, right] = range_of(loading.displacement_um, unloading.displacement_um);
  const auto [bottom, top] = range_of(loading.force_un, unloading.force_un);
  Chart chart(kArea, {left, right}, {bottom, top + 0.25 * (top - bottom)});
  add_branch(chart, sheet, unloading, kGrey, kOrange);
  add_branch(chart, sheet, loading, kBlue, kRed);
  sheet.add(chart);
  sheet.write("displacement (\u00b5m)", kArea.middle_x(), 0.042);
  sheet.write_upright("force (\u00b5N)", 0.032, kArea.middle_y());
  return sheet.figure();
}

}  // namespace pendular::viz
