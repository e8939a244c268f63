#include "diagnosis_report/overlay_figures.h"
#include "diagnosis/kinds/kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/quantile.h"
#include "diagnosis_report/overlay_views.h"
#include "viz/band_plot.h"
#include "viz/row_plot.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Columns;
using diagnosis::Overlay;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMany = 20;         // realisations from which the band is of quantiles
constexpr std::size_t kDensePoints = 60;  // from which on measured points are drawn as a line

/// What the realisations of a test come to on the places where the measured one is.
struct Spread {
  std::string name;  ///< of CSV columns
  std::string label;
  std::vector<double> low, mean, high;
  std::vector<Trace> shown;  ///< of each realisation
};

/// y at x by straight lines; NaN outside.
double at(const Trace& trace, double x) {
  if (trace.x.empty() || !(x >= trace.x.front()) || !(x <= trace.x.back())) return kNone;
  const auto after = std::lower_bound(trace.x.begin(), trace.x.end(), x);
  const auto k = static_cast<std::size_t>(after - trace.x.begin());
  if (k == 0 || trace.x[k] == x) return trace.y[k];
  const double t = (x - trace.x[k - 1]) / (trace.x[k] - trace.x[k - 1]);
  return trace.y[k - 1] + t * (trace.y[k] - trace.y[k - 1]);
}

Spread spread_of(const OverlayView& view, const std::vector<Columns>& runs, const std::vector<double>& places,
                 const std::string& name, const std::string& label) {
  Spread spread{
      name, fmt::format("{} ({} run{})", label, runs.size(), runs.size() == 1 ? "" : "s"), {}, {}, {}, {}};
  std::vector<Trace> compared;
  for (const Columns& run : runs) {
    compared.push_back(view.compared(run));
    spread.shown.push_back(view.shown(run));
  }
  const double cut = runs.size() >= kMany ? 0.05 : 0.0;
  for (const double x : places) {
    std::vector<double> values;
    for (const Trace& trace : compared) {
      const double y = at(trace, x);
      if (std::isfinite(y)) values.push_back(y);
    }
    const bool any = !values.empty();
    spread.low.push_back(quantile(values, cut));
    spread.high.push_back(quantile(values, 1.0 - cut));
    spread.mean.push_back(any ? std::accumulate(values.begin(), values.end(), 0.0) /
                                    static_cast<double>(values.size())
                              : kNone);
  }
  return spread;
}

std::vector<double> scaled(std::vector<double> values, double scale) {
  for (double& v : values) v *= scale;
  return values;
}

std::vector<double> less(std::vector<double> values, const std::vector<double>& other, double scale) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = scale * (values[k] - other[k]);
  return values;
}

viz::Series series_of(const Trace& trace, const OverlayView& view) {
  return {"", scaled(trace.x, view.x_scale), scaled(trace.y, view.y_scale), scaled(trace.sd, view.y_scale)};
}

/// Without what lies beyond the measured places, where the axes end: what a run does there would set their
/// range.
Trace up_to(double last, const Trace& trace) {
  Trace kept;
  for (std::size_t k = 0; k < trace.x.size(); ++k)
    if (trace.x[k] <= last) kept.x.push_back(trace.x[k]), kept.y.push_back(trace.y[k]);
  return kept;
}

viz::BandPlot plot_of(const OverlayView& view, const Trace& measured, const Trace& compared,
                      const std::vector<Spread>& spreads) {
  viz::BandPlot plot{view.x_title, view.y_title, "difference (" + view.residual_title + ")", {}, {}, {}, {}};
  plot.measured = series_of(measured, view);
  plot.measured.label = "measured";
  if (!view.measured_as_points && measured.x.size() > kDensePoints)
    plot.measured.look = viz::Series::Look::line;
  const auto x = scaled(compared.x, view.x_scale);
  const double last = measured.x.empty() ? kNone : *std::max_element(measured.x.begin(), measured.x.end());
  for (const Spread& spread : spreads) {
    viz::Band band{spread.label, x, scaled(spread.low, view.y_scale), scaled(spread.mean, view.y_scale),
                   scaled(spread.high, view.y_scale)};
    viz::Band residual{"", x, less(spread.low, compared.y, view.y_scale),
                       less(spread.mean, compared.y, view.y_scale),
                       less(spread.high, compared.y, view.y_scale)};
    if (!view.measured_as_points)
      for (const Trace& trace : spread.shown) band.lines.push_back(series_of(up_to(last, trace), view));
    plot.bands.push_back(std::move(band));
    plot.residuals.push_back(std::move(residual));
  }
  if (!compared.sd.empty())
    plot.error = {"", x, scaled(compared.sd, -view.y_scale), std::vector<double>(x.size(), 0.0),
                  scaled(compared.sd, view.y_scale)};
  return plot;
}

/// The measured values, the bands and their differences.
Table band_table(const OverlayView& view, const Trace& compared, const std::vector<Spread>& spreads) {
  Table table{"", {view.x_name, "measured_" + view.y_name, "measured_sigma"}, {}};
  for (const Spread& spread : spreads)
    for (const char* part : {"_low", "_mean", "_high", "_mean_less_measured"})
      table.columns.push_back(spread.name + part);
  for (std::size_t k = 0; k < compared.x.size(); ++k) {
    std::vector<Cell> row = {compared.x[k], compared.y[k], compared.sd.empty() ? kNone : compared.sd[k]};
    for (const Spread& s : spreads)
      for (const double value : {s.low[k], s.mean[k], s.high[k], s.mean[k] - compared.y[k]})
        row.emplace_back(value);
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Every test by itself, as drawn.
Table run_table(const OverlayView& view, const Trace& measured, const std::vector<Spread>& spreads) {
  Table table{"", {"data", "realisation", view.x_name, view.y_name}, {}};
  const auto add = [&](const std::string& name, std::size_t realisation, const Trace& trace) {
    for (std::size_t k = 0; k < trace.x.size(); ++k)
      table.rows.push_back({name, static_cast<double>(realisation), trace.x[k], trace.y[k]});
  };
  add("measured", 1, measured);
  for (const Spread& spread : spreads)
    for (std::size_t k = 0; k < spread.shown.size(); ++k) add(spread.name, k + 1, spread.shown[k]);
  return table;
}

std::string caption_of(const Overlay& overlay, const Trace& compared) {
  std::string text = fmt::format("{} ({}): measured", overlay.observation, overlay.kind->name);
  if (!overlay.simulated.empty()) text += ", simulated as believed";
  if (!overlay.repaired.empty()) text += ", simulated with the best explanation";
  text += fmt::format(
      ". Bands: least to largest of the realisations ({} and more of them: 5 to 95 %), with their mean. "
      "Below: "
      "simulated less measured",
      kMany);
  if (overlay.kind == &diagnosis::kinds::compression()) text += ", on first loading";
  return text + (compared.sd.empty() ? "." : "; grey: the measurement's standard deviation.");
}

std::vector<Drawn> band_figures(const Overlay& overlay, const std::string& name) {
  std::vector<Drawn> figures;
  for (const OverlayView& view : views_of(overlay)) {
    const Trace measured = view.shown(overlay.measured), compared = view.compared(overlay.measured);
    if (measured.x.empty()) continue;
    std::vector<Spread> spreads;
    if (!overlay.simulated.empty())
      spreads.push_back(spread_of(view, overlay.simulated, compared.x, "simulated", "as believed"));
    if (!overlay.repaired.empty())
      spreads.push_back(
          spread_of(view, overlay.repaired, compared.x, "repaired", "with the best explanation"));
    Drawn figure{viz::band_figure(plot_of(view, measured, compared, spreads)),
                 caption_of(overlay, compared),
                 band_table(view, compared, spreads),
                 {run_table(view, measured, spreads)}};
    figure.data.name = name + view.suffix;
    figure.more[0].name = figure.data.name + "_runs";
    figures.push_back(std::move(figure));
  }
  return figures;
}

/// An observation that is one number.
Drawn number_figure(const Overlay& overlay, const std::string& name, const std::string& column) {
  viz::RowPlot plot;
  viz::RowSeries series;
  series.look = viz::RowSeries::Look::points;
  Table table{name, {"data", "low", "mean", "high"}, {}};
  const auto add = [&](const std::string& label, double low, double mean, double high) {
    plot.labels.push_back(label);
    series.values.push_back(mean);
    series.intervals.emplace_back(low, high);
    table.rows.push_back({label, low, mean, high});
  };
  const auto mean_of = [&](const Columns& columns) {
    if (!columns.contains(column) || columns.at(column).empty()) return kNone;
    const auto& values = columns.at(column);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const auto add_runs = [&](const std::string& label, const std::vector<Columns>& runs) {
    std::vector<double> values;
    for (const Columns& run : runs)
      if (const double v = mean_of(run); std::isfinite(v)) values.push_back(v);
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    add(label, values.front(),
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()),
        values.back());
  };
  const double measured = mean_of(overlay.measured);
  const auto sigma = overlay.measured.find(column + "_sigma");
  const double sd = sigma == overlay.measured.end() || sigma->second.empty() ? 0.0 : sigma->second.front();
  add("measured", measured - sd, measured, measured + sd);
  add_runs("as believed", overlay.simulated);
  add_runs("with the best explanation", overlay.repaired);
  const auto [least, most] = std::minmax_element(series.values.begin(), series.values.end());
  plot.panels = {{"bridges per interior bead", {series}, {}, {}, 0.95 * *least, 1.05 * *most}};
  return {viz::row_figure(plot),
          fmt::format("{} ({}): measured with its standard deviation, and the realisations from least to "
                      "largest.",
                      overlay.observation, overlay.kind->name),
          table};
}

}  // namespace

std::vector<Drawn> overlay_figures(const diagnosis::Diagnosis& d) {
  std::vector<Drawn> figures;
  for (std::size_t k = 0; k < d.overlays.size(); ++k) {
    const Overlay& overlay = d.overlays[k];
    const std::string name = fmt::format("overlay_{}_{}", k + 1, overlay.observation);
    if (overlay.kind == &diagnosis::kinds::coordination()) {
      figures.push_back(number_figure(overlay, name, "z"));
      continue;
    }
    for (Drawn& figure : band_figures(overlay, name)) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace pendular::diagnosis_report
