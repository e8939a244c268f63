#include "viz/plot.h"

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

/// Broken bonds per bin over [0, largest strain], as boxes over strain in %.
std::vector<Rectangle> break_histogram(const RunFolder& run, double largest) {
  const std::size_t bins = static_cast<std::size_t>(std::ceil(largest / kBreakBin)) + 1;
  std::vector<double> counts(bins, 0.0);
  for (double strain : run.break_strain) {
    const double bin = strain / kBreakBin;
    if (bin >= 0.0 && bin < static_cast<double>(bins)) counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  std::vector<Rectangle> bars;
  for (std::size_t b = 0; b < bins; ++b)
    if (counts[b] > 0.0)
      bars.push_back({100.0 * static_cast<double>(b) * kBreakBin, 0.0,
                      100.0 * static_cast<double>(b + 1) * kBreakBin, counts[b]});
  return bars;
}

void add_marks(Chart& chart, const RunFolder& run, const Sheet& sheet) {
  const RunResult& result = run.result;
  if (result.linear_limit) {
    const double strain = result.toe + *result.linear_limit;
    chart.add_points({{100.0 * strain, 1e-6 * stress_at(run, strain)}}, kGreen, sheet.scaled(26),
                     fmt::format("linear limit, {:.2f} % beyond the toe", 100.0 * *result.linear_limit),
                     Marker::diamond);
  }
  if (result.peak_strain && result.peak_stress)
    chart.add_points({{100.0 * (result.toe + *result.peak_strain), 1e-6 * *result.peak_stress}}, kRed,
                     sheet.scaled(22), fmt::format("peak, {:.3g} MPa", 1e-6 * *result.peak_stress));
}

/// From the toe to where the line would pass the highest stress drawn.
void add_fit(Chart& chart, const RunResult& result, double highest, const Sheet& sheet) {
  if (!result.modulus || !(*result.modulus > 0.0)) return;
  const double toe = result.toe, end = toe + 1.05 * highest / *result.modulus;
  chart.add_line({{100.0 * toe, 0.0}, {100.0 * end, 1.05e-6 * highest}}, {kBlack, sheet.scaled(3), true},
                 fmt::format("linear fit, E = {:.3g} MPa", 1e-6 * *result.modulus));
}

/// Runs after the first, under one entry of the legend.
void add_other_runs(Chart& chart, std::span<const RunFolder> runs, const Sheet& sheet) {
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const std::string label =
        r == 1 ? fmt::format("{} more realisation{}", runs.size() - 1, runs.size() > 2 ? "s" : "") : "";
    chart.add_line(curve_of(runs[r]), {kGrey, sheet.scaled(3)}, label);
  }
}

}  // namespace

Figure stress_strain_figure(std::span<const RunFolder> runs, PictureSize size) {
  double longest = 0.0, highest = 0.0;
  for (const RunFolder& run : runs) {
    longest = std::max(longest, *std::max_element(run.strain.begin(), run.strain.end()));
    highest = std::max(highest, *std::max_element(run.stress.begin(), run.stress.end()));
  }
  if (!(longest > 0.0)) longest = kBreakBin;
  if (!(highest > 0.0)) highest = 1.0;

  Sheet sheet(size);
  Chart chart(kArea, {0.0, 100.0 * longest}, {0.0, 1.5e-6 * highest});
  const RunFolder& first = runs.front();
  const auto bars = break_histogram(first, longest);
  if (!bars.empty()) {
    double most = 0.0;
    for (const Rectangle& bar : bars) most = std::max(most, bar.top);
    chart.set_right_axis({0.0, kBarHeadroom * most});
    chart.add_boxes(bars, kBars, fmt::format("broken bonds per {:.3f} % strain", 100.0 * kBreakBin));
    sheet.write_upright("broken bonds per bin", 0.965, kArea.middle_y());
  }
  add_other_runs(chart, runs, sheet);
  chart.add_line(curve_of(first), {kBlue, sheet.scaled(5)},
                 runs.size() > 1 ? "first realisation" : "simulation");
  add_fit(chart, first.result, highest, sheet);
  add_marks(chart, first, sheet);
  sheet.add(chart);
  sheet.write("strain (%)", kArea.middle_x(), 0.042);
  sheet.write_upright("stress (MPa)", 0.032, kArea.middle_y());
  return sheet.figure();
}

}  // namespace pendular::viz
