#include "viz/pipette_plot.h"

#include <vtkAxis.h>
#include <vtkPlotPoints.h>

#include <algorithm>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

using Values = std::vector<double>;

constexpr Colour kBlue{31, 90, 165}, kGrey{130, 130, 130}, kRed{190, 40, 30}, kOrange{215, 120, 30};
constexpr Area kArea{0.12, 0.125, 0.84, 0.845};

void add_branch(vtkChartXY* chart, const Canvas& canvas, const ForceBranch& branch, const Colour& points,
                const Colour& line) {
  if (branch.force_un.empty()) return;
  Points measured;
  for (std::size_t k = 0; k < branch.force_un.size(); ++k)
    measured.emplace_back(branch.displacement_um[k], branch.force_un[k]);
  auto* plot = vtkPlotPoints::SafeDownCast(
      add_plot(chart, vtkChart::POINTS, measured, branch.label, points, canvas.scaled(3)));
  plot->SetMarkerStyle(vtkPlotPoints::CIRCLE);
  plot->SetMarkerSize(static_cast<float>(canvas.scaled(12)));
  if (!branch.line) return;
  const auto& l = *branch.line;
  add_plot(chart, vtkChart::LINE,
           {{l.first_um, l.intercept + l.slope * l.first_um}, {l.last_um, l.intercept + l.slope * l.last_um}},
           l.label, line, canvas.scaled(5));
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

Image draw_force_displacement(const Display& display, const ForceBranch& loading,
                              const ForceBranch& unloading, PictureSize size) {
  ChartSheet sheet(display, size);
  const Canvas& canvas = sheet.canvas();
  vtkChartXY* chart = sheet.add_chart(kArea);
  add_branch(chart, canvas, unloading, kGrey, kOrange);
  add_branch(chart, canvas, loading, kBlue, kRed);
  const auto [left, right] = range_of(loading.displacement_um, unloading.displacement_um);
  const auto [bottom, top] = range_of(loading.force_un, unloading.force_un);
  set_axis(chart->GetAxis(vtkAxis::BOTTOM), left, right, canvas);
  set_axis(chart->GetAxis(vtkAxis::LEFT), bottom, top + 0.25 * (top - bottom), canvas);
  sheet.write("displacement (\xC2\xB5m)", kArea.middle_x(), 0.042);
  sheet.write_upright("force (\xC2\xB5N)", 0.032, kArea.middle_y());
  return sheet.draw();
}

}  // namespace pendular::viz
