#include "diagnosis_report/overlay_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Columns;
using diagnosis::Kind;
namespace kinds = diagnosis::kinds;
using diagnosis::Overlay;

constexpr std::size_t kBins = 12;         // along z, for displacements
constexpr std::size_t kSharePoints = 81;  // at which shares of samples are compared

Trace columns_as(const Columns& columns, const std::string& x, const std::string& y, const std::string& sd) {
  Trace trace;
  if (!columns.contains(x) || !columns.contains(y)) return trace;
  trace = {columns.at(x), columns.at(y)};
  if (columns.contains(sd)) trace.sd = columns.at(sd);
  return trace;
}

Trace picked(const Trace& trace, const std::vector<std::size_t>& rows) {
  Trace out;
  for (const std::size_t k : rows) {
    out.x.push_back(trace.x[k]), out.y.push_back(trace.y[k]);
    if (!trace.sd.empty()) out.sd.push_back(trace.sd[k]);
  }
  return out;
}

/// The rows at which x is larger than ever before: a curve without its unloadings.
Trace first_loading(const Trace& trace) {
  std::vector<std::size_t> rows;
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < trace.x.size(); ++k)
    if (trace.x[k] > farthest) rows.push_back(k), farthest = trace.x[k];
  return picked(trace, rows);
}

Trace sorted(const Trace& trace) {
  std::vector<std::size_t> rows(trace.x.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::stable_sort(rows.begin(), rows.end(),
                   [&](std::size_t a, std::size_t b) { return trace.x[a] < trace.x[b]; });
  return picked(trace, rows);
}

/// Share of a sample that is at or below x, as steps.
Trace share_below(const Columns& columns, const std::string& name) {
  Trace trace;
  if (!columns.contains(name)) return trace;
  auto values = columns.at(name);
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    for (const std::size_t count : {k, k + 1})
      trace.x.push_back(values[k]), trace.y.push_back(static_cast<double>(count) / n);
  return trace;
}

/// The same at evenly spaced places from `low` to `high`.
Trace share_below_at(const Columns& columns, const std::string& name, double low, double high) {
  Trace trace;
  if (!columns.contains(name)) return trace;
  const auto& values = columns.at(name);
  for (std::size_t k = 0; k < kSharePoints; ++k) {
    const double x = low + (high - low) * static_cast<double>(k) / (kSharePoints - 1.0);
    const auto below = std::count_if(values.begin(), values.end(), [&](double v) { return v <= x; });
    trace.x.push_back(x);
    trace.y.push_back(static_cast<double>(below) / static_cast<double>(values.size()));
  }
  return trace;
}

/// u_z over z at the last strain.
Trace rise(const Columns& columns) {
  Trace all = columns_as(columns, "z_um", "uz_um", "");
  const auto strain = columns.find("strain");
  if (strain == columns.end() || strain->second.empty()) return all;
  const double last = *std::max_element(strain->second.begin(), strain->second.end());
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < all.x.size(); ++k)
    if (strain->second[k] == last) rows.push_back(k);
  return picked(all, rows);
}

/// Means of y, and their standard errors, in bins of x from `low` to `high`; NaN where fewer than two are.
Trace binned(const Trace& trace, double low, double high) {
  std::vector<double> count(kBins, 0.0), sum(kBins, 0.0), square(kBins, 0.0);
  for (std::size_t k = 0; k < trace.x.size(); ++k) {
    const double at = (trace.x[k] - low) / (high - low) * static_cast<double>(kBins);
    if (!(at >= 0.0) || at > static_cast<double>(kBins)) continue;
    const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(at));
    count[bin] += 1.0, sum[bin] += trace.y[k], square[bin] += trace.y[k] * trace.y[k];
  }
  Trace out;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const bool enough = count[bin] >= 2.0;
    const double mean = sum[bin] / count[bin],
                 variance = std::max(0.0, square[bin] / count[bin] - mean * mean) / (count[bin] - 1.0);
    out.x.push_back(low + (high - low) * (static_cast<double>(bin) + 0.5) / static_cast<double>(kBins));
    out.y.push_back(enough ? mean : std::numeric_limits<double>::quiet_NaN());
    out.sd.push_back(enough ? std::sqrt(variance) : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

/// Least and largest value of a column over all tests of an overlay.
std::pair<double, double> extent(const Overlay& overlay, const std::string& name) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto hold = [&](const Columns& columns) {
    if (!columns.contains(name)) return;
    for (const double v : columns.at(name)) low = std::min(low, v), high = std::max(high, v);
  };
  hold(overlay.measured);
  for (const auto* runs : {&overlay.simulated, &overlay.repaired})
    for (const Columns& columns : *runs) hold(columns);
  return high > low ? std::pair(low, high) : std::pair(low - 0.5, low + 0.5);
}

/// A unit in which the largest stress is not a long number.
std::pair<double, std::string> stress_unit(const Overlay& overlay, const std::string& name) {
  const double largest = extent(overlay, name).second;
  if (largest >= 1e5) return {1e-6, "MPa"};
  if (largest >= 100.0) return {1e-3, "kPa"};
  return {1.0, "Pa"};
}

OverlayView over_strain(const std::string& y, const std::string& sd, const std::string& title, double scale,
                        const std::string& unit) {
  OverlayView view{"", "strain", y, "platen strain (%)", title, 100.0, scale, unit, {}, {}};
  view.shown = [=](const Columns& columns) { return columns_as(columns, "strain", y, sd); };
  view.compared = [shown = view.shown](const Columns& columns) { return first_loading(shown(columns)); };
  return view;
}

OverlayView over_values(const std::string& suffix, const std::string& x, const std::string& y,
                        const std::string& sd) {
  OverlayView view{suffix, x, y, "", "", 1.0, 1.0, "", {}, {}};
  view.shown = [=](const Columns& columns) { return sorted(columns_as(columns, x, y, sd)); };
  view.compared = view.shown;
  view.measured_as_points = true;
  return view;
}

OverlayView modulus_view(const Overlay& overlay) {
  const bool by_content = overlay.measured.contains("W");
  const std::string x = by_content ? "W" : "E_p_pa";
  OverlayView view = over_values("", x, "modulus_pa", "modulus_sigma_pa");
  const auto [x_scale, x_unit] = stress_unit(overlay, x);
  const auto [y_scale, y_unit] = stress_unit(overlay, "modulus_pa");
  view.x_scale = by_content ? 100.0 : x_scale;
  view.x_title = by_content ? "polymer content W (%)" : "modulus of the polymer (" + x_unit + ")";
  view.y_scale = y_scale, view.residual_title = y_unit;
  view.y_title = "modulus (" + y_unit + ")";
  return view;
}

OverlayView stiffness_view(const std::string& name) {
  OverlayView view = over_values("_" + name, "d_um", name + "_n_per_m", name + "_sigma_n_per_m");
  view.x_title = "bridge diameter d (\u00b5m)";
  view.y_title = name + " (N/m)";
  view.residual_title = "N/m";
  return view;
}

OverlayView sample_view(const Overlay& overlay, const std::string& name, const std::string& title) {
  const auto [low, high] = extent(overlay, name);
  OverlayView view{"", name, "share", title, "share at or below", 1.0, 1.0, "share", {}, {}};
  view.shown = [=](const Columns& columns) { return share_below(columns, name); };
  view.compared = [=, low = low, high = high](const Columns& columns) {
    return share_below_at(columns, name, low, high);
  };
  return view;
}

OverlayView displacement_view(const Overlay& overlay) {
  const auto [low, high] = extent(overlay, "z_um");
  OverlayView view{
      "",        "z_um", "uz_um", "height z (\u00b5m)", "displacement along z (\u00b5m)", 1.0, 1.0,
      "\u00b5m", rise,   {}};
  view.compared = [low = low, high = high](const Columns& columns) {
    return binned(rise(columns), low, high);
  };
  view.measured_as_points = true;
  return view;
}

}  // namespace

std::vector<OverlayView> views_of(const Overlay& overlay) {
  using Views = std::vector<OverlayView>;
  static const std::map<const Kind*, std::function<Views(const Overlay&)>> all = {
      {&kinds::compression(),
       [](const Overlay& o) {
         const auto [scale, unit] = stress_unit(o, "stress_pa");
         return Views{over_strain("stress_pa", "stress_sigma_pa", "stress (" + unit + ")", scale, unit)};
       }},
      {&kinds::lateral_strain(),
       [](const Overlay&) {
         return Views{over_strain("lateral_strain", "sigma", "lateral strain (%)", 100.0, "%")};
       }},
      {&kinds::broken_bonds(),
       [](const Overlay&) { return Views{over_strain("count", "", "broken bonds", 1.0, "bonds")}; }},
      {&kinds::modulus_series(), [](const Overlay& o) { return Views{modulus_view(o)}; }},
      {&kinds::bridge_stiffness(),
       [](const Overlay& o) {
         Views views;
         for (const char* name : {"kn", "kt"})
           if (o.measured.contains(std::string(name) + "_n_per_m")) views.push_back(stiffness_view(name));
         return views;
       }},
      {&kinds::bridge_diameters(),
       [](const Overlay& o) { return Views{sample_view(o, "d_um", "bridge diameter d (\u00b5m)")}; }},
      {&kinds::bridge_gaps(),
       [](const Overlay& o) { return Views{sample_view(o, "gap_um", "gap (\u00b5m)")}; }},
      {&kinds::displacements(), [](const Overlay& o) { return Views{displacement_view(o)}; }}};
  const auto found = all.find(overlay.kind);
  return found == all.end() ? Views{} : found->second(overlay);
}

}  // namespace pendular::diagnosis_report
