#include "dem_core/observe/curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/line_fit.h"

namespace pendular::dem_core {
namespace {

struct Points {
  std::vector<double> x, y;
  std::size_t size() const { return x.size(); }
};

/// Rows that reach a strain never reached before: unloading loops are not part of the envelope.
Points loading_branch(const std::vector<CurveRow>& rows) {
  Points points;
  double reached = -1.0;
  for (const auto& row : rows) {
    if (row.strain <= reached) continue;
    reached = row.strain;
    points.x.push_back(row.strain);
    points.y.push_back(row.stress);
  }
  return points;
}

Line fit(const Points& p, std::size_t first, std::size_t last) {
  return line_through(std::span(p.x).subspan(first, last - first),
                      std::span(p.y).subspan(first, last - first));
}

double worst_residual(const Points& p, const Line& line, std::size_t first, std::size_t last) {
  double worst = 0.0;
  for (std::size_t k = first; k < last; ++k) worst = std::max(worst, std::fabs(p.y[k] - line.at(p.x[k])));
  return worst;
}

/// Standard error of the slope; neighbouring residuals are correlated, which leaves fewer independent points.
double slope_sigma(const Points& p, const Line& line, std::size_t first, std::size_t last) {
  const double n = static_cast<double>(last - first);
  double mx = 0.0, xx = 0.0, rr = 0.0, lag = 0.0;
  for (std::size_t k = first; k < last; ++k) mx += p.x[k] / n;
  for (std::size_t k = first; k < last; ++k) {
    const double r = p.y[k] - line.at(p.x[k]);
    xx += (p.x[k] - mx) * (p.x[k] - mx);
    rr += r * r;
    if (k + 1 < last) lag += r * (p.y[k + 1] - line.at(p.x[k + 1]));
  }
  if (rr == 0.0 || n <= 2.0) return 0.0;
  const double correlation = std::clamp(lag / rr, 0.0, 0.98);
  return std::sqrt(rr / (n - 2.0) / xx * (1.0 + correlation) / (1.0 - correlation));
}

struct Range {
  std::size_t first, last;
};

Range steepest_window(const Points& p, std::size_t peak) {
  const double width = 0.25 * p.x[peak];
  Range best{0, 0};
  double steepest = 0.0;
  std::size_t last = 0;
  for (std::size_t first = 0; first <= peak; ++first) {
    while (last <= peak && p.x[last] - p.x[first] < width) ++last;
    if (last > peak) break;
    const std::size_t end = std::max(last + 1, first + 4);
    if (end > peak + 1) break;
    const double slope = fit(p, first, end).slope;
    if (slope > steepest) steepest = slope, best = {first, end};
  }
  return best;
}

Range grown(const Points& p, Range range, std::size_t peak) {
  const double tolerance = 0.01 * p.y[peak];
  auto straight = [&](std::size_t first, std::size_t last) {
    return worst_residual(p, fit(p, first, last), first, last) <= tolerance;
  };
  bool left = true, right = true;
  while (left || right) {
    left = left && range.first > 0 && straight(range.first - 1, range.last);
    if (left) --range.first;
    right = right && range.last <= peak && straight(range.first, range.last + 1);
    if (right) ++range.last;
  }
  return range;
}

}  // namespace

std::optional<CurveFeatures> curve_features(const std::vector<CurveRow>& rows) {
  const Points p = loading_branch(rows);
  if (p.size() < 8) return std::nullopt;
  const std::size_t peak = static_cast<std::size_t>(std::max_element(p.y.begin(), p.y.end()) - p.y.begin());
  if (p.y[peak] <= 0.0 || peak < 4) return std::nullopt;
  const Range window = steepest_window(p, peak);
  if (window.first == window.last) return std::nullopt;
  const Range range = grown(p, window, peak);
  const Line line = fit(p, range.first, range.last);
  CurveFeatures features;
  features.modulus = line.slope;
  features.modulus_sigma = slope_sigma(p, line, range.first, range.last);
  features.fit_from = p.x[range.first];
  features.fit_to = p.x[range.last - 1];
  features.toe_strain = -line.intercept / line.slope;
  features.peak_strain = p.x[peak] - features.toe_strain;
  features.peak_stress = p.y[peak];
  for (std::size_t k = range.first; k < p.size() && !features.linear_limit; ++k)
    if (p.x[k] > 0.5 * (features.fit_from + features.fit_to) && p.y[k] < 0.95 * line.at(p.x[k]))
      features.linear_limit = p.x[k] - features.toe_strain;
  for (std::size_t k = peak; k < p.size(); ++k) features.peak_passed |= p.y[k] < 0.95 * p.y[peak];
  return features;
}

}  // namespace pendular::dem_core
