#include "viz/plot.h"

#include <vtkAxis.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

constexpr Colour kBlue{31, 90, 165}, kGrey{150, 165, 185}, kBlack{30, 30, 30}, kRed{190, 40, 30},
    kGreen{20, 130, 80}, kBars{236, 190, 140};

constexpr Area kArea{0.11, 0.125, 0.77, 0.845};

constexpr double kBarHeadroom = 1.7;  // height of the plot over the highest bar

Points curve_of(const RunFolder& run) {
  Points points;
  for (std::size_t k = 0; k < run.strain.size(); ++k)
    points.emplace_back(100.0 * run.strain[k], 1e-6 * run.stress[k]);
  return points;
}

/// Stress of a curve where it first reaches a strain, Pa; between rows by straight lines.
double stress_at(const RunFolder& run, double strain) {
  for (std::size_t k = 1; k < run.strain.size(); ++k) {
    if (run.strain[k] < strain || run.strain[k] <= run.strain[k - 1]) continue;
    const double t = (strain - run.strain[k - 1]) / (run.strain[k] - run.strain[k - 1]);
    return run.stress[k - 1] + std::clamp(t, 0.0, 1.0) * (run.stress[k] - run.stress[k - 1]);
  }
  return run.stress.back();
}

/// Broken bonds per bin over [0, largest strain].
Points break_histogram(const RunFolder& run, double largest) {
  const std::size_t bins = static_cast<std::size_t>(std::ceil(largest / kBreakBin)) + 1;
  std::vector<double> counts(bins, 0.0);
  for (double strain : run.break_strain) {
    const double bin = strain / kBreakBin;
    if (bin >= 0.0 && bin < static_cast<double>(bins)) counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  Points points;
  for (std::size_t b = 0; b < bins; ++b)
    points.emplace_back(100.0 * (static_cast<double>(b) + 0.5) * kBreakBin, counts[b]);
  return points;
}

void add_marks(vtkChartXY* chart, const RunFolder& run, const Canvas& canvas) {
  const RunResult& result = run.result;
  const auto mark = [&](double strain, double stress, const std::string& label, int style, Colour colour) {
    auto* plot = vtkPlotPoints::SafeDownCast(add_plot(
        chart, vtkChart::POINTS, {{100.0 * strain, 1e-6 * stress}}, label, colour, canvas.scaled(8)));
    plot->SetMarkerStyle(style);
    plot->SetMarkerSize(static_cast<float>(canvas.scaled(20)));
  };
  if (result.linear_limit)
    mark(result.toe + *result.linear_limit, stress_at(run, result.toe + *result.linear_limit),
         fmt::format("linear limit, {:.2f} % beyond the toe", 100.0 * *result.linear_limit),
         vtkPlotPoints::DIAMOND, kGreen);
  if (result.peak_strain && result.peak_stress)
    mark(result.toe + *result.peak_strain, *result.peak_stress,
         fmt::format("peak, {:.3g} MPa", 1e-6 * *result.peak_stress), vtkPlotPoints::CIRCLE, kRed);
}

/// From the toe to where the line would pass the highest stress drawn.
void add_fit(vtkChartXY* chart, const RunResult& result, double highest, const Canvas& canvas) {
  if (!result.modulus || !(*result.modulus > 0.0)) return;
  const double toe = result.toe, end = toe + 1.05 * highest / *result.modulus;
  const Points line = {{100.0 * toe, 0.0}, {100.0 * end, 1.05e-6 * highest}};
  vtkPlot* plot =
      add_plot(chart, vtkChart::LINE, line, fmt::format("linear fit, E = {:.3g} MPa", 1e-6 * *result.modulus),
               kBlack, canvas.scaled(3));
  plot->GetPen()->SetLineType(vtkPen::DASH_LINE);
}

/// Runs after the first, under one entry of the legend.
void add_other_runs(vtkChartXY* chart, std::span<const RunFolder> runs, const Canvas& canvas) {
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const std::string label =
        r == 1 ? fmt::format("{} more realisation{}", runs.size() - 1, runs.size() > 2 ? "s" : "") : "";
    add_plot(chart, vtkChart::LINE, curve_of(runs[r]), label, kGrey, canvas.scaled(3));
  }
}

}  // namespace

Image draw_stress_strain(const Display& display, std::span<const RunFolder> runs, PictureSize size) {
  double longest = 0.0, highest = 0.0;
  for (const RunFolder& run : runs) {
    longest = std::max(longest, *std::max_element(run.strain.begin(), run.strain.end()));
    highest = std::max(highest, *std::max_element(run.stress.begin(), run.stress.end()));
  }
  if (!(longest > 0.0)) longest = kBreakBin;
  if (!(highest > 0.0)) highest = 1.0;

  ChartSheet sheet(display, size);
  const Canvas& canvas = sheet.canvas();
  vtkChartXY* chart = sheet.add_chart(kArea);
  chart->SetBarWidthFraction(1.0f);

  const RunFolder& first = runs.front();
  double most = 0.0;
  const double top = 1.5e-6 * highest;
  if (!first.break_strain.empty()) {
    Points bars = break_histogram(first, longest);
    for (const auto& bar : bars) most = std::max(most, bar.second);
    // The bars stand on the left axis in its unit, because plots of the right axis would cover the curves.
    for (auto& bar : bars) bar.second *= top / (kBarHeadroom * most);
    vtkPlot* plot = add_plot(chart, vtkChart::BAR, bars,
                             fmt::format("broken bonds per {:.3f} % strain", 100.0 * kBreakBin), kBars, 1);
    plot->GetPen()->SetOpacity(0);
  }
  add_other_runs(chart, runs, canvas);
  add_plot(chart, vtkChart::LINE, curve_of(first), runs.size() > 1 ? "first realisation" : "simulation",
           kBlue, canvas.scaled(5));
  add_fit(chart, first.result, highest, canvas);
  add_marks(chart, first, canvas);

  set_axis(chart->GetAxis(vtkAxis::BOTTOM), 0.0, 100.0 * longest, canvas);
  set_axis(chart->GetAxis(vtkAxis::LEFT), 0.0, top, canvas);
  if (most > 0.0) {
    chart->SetPlotCorner(add_plot(chart, vtkChart::LINE, {{0.0, 0.0}, {0.0, 0.0}}, "", kBars, 0),
                         1);  // brings up the right axis
    set_axis(chart->GetAxis(vtkAxis::RIGHT), 0.0, top, canvas, kBarHeadroom * most / top);
    sheet.write_upright("broken bonds per bin", 0.965, kArea.middle_y());
  }
  sheet.write("strain (%)", kArea.middle_x(), 0.042);
  sheet.write_upright("stress (MPa)", 0.032, kArea.middle_y());
  return sheet.draw();
}

}  // namespace pendular::viz
