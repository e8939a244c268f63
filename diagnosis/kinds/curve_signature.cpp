#include "diagnosis/kinds/curve_signature.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/line_fit.h"
#include "dem_core/observe/curve.h"

namespace pendular::diagnosis {
namespace {

constexpr int kPoints = 150;              // of a smoothed envelope
constexpr double kWindow = 1.0 / 50.0;    // half width of the lines that smooth, over the range
constexpr double kLeastUnloading = 2e-3;  // strain
constexpr double kUnloaded = 0.25;        // of the stress at the turn

/// The part of a curve that reaches strains for the first time.
Curve envelope_of(const Curve& curve, double last_strain) {
  Curve envelope;
  double reached = -1.0;
  for (std::size_t k = 0; k < curve.strain.size(); ++k) {
    if (curve.strain[k] <= reached || curve.strain[k] > last_strain) continue;
    reached = curve.strain[k];
    envelope.strain.push_back(reached);
    envelope.stress.push_back(curve.stress[k]);
  }
  return envelope;
}

/// Value at x of the line through the points within `half` of x, at least three.
double smoothed_at(const Curve& curve, double x, double half) {
  const auto begin = curve.strain.begin(), end = curve.strain.end();
  auto first = std::lower_bound(begin, end, x - half), last = std::upper_bound(begin, end, x + half);
  while (last - first < 3 && (first != begin || last != end)) {
    if (first != begin) --first;
    if (last != end) ++last;
  }
  const auto from = static_cast<std::size_t>(first - begin), count = static_cast<std::size_t>(last - first);
  return line_through(std::span(curve.strain).subspan(from, count),
                      std::span(curve.stress).subspan(from, count))
      .at(x);
}

Curve smoothed(const Curve& envelope) {
  const double from = envelope.strain.front(), range = envelope.strain.back() - from;
  Curve smooth;
  for (int k = 0; k < kPoints; ++k) {
    const double x = from + range * k / (kPoints - 1);
    smooth.strain.push_back(x);
    smooth.stress.push_back(smoothed_at(envelope, x, kWindow * range));
  }
  return smooth;
}

/// Stress of a curve of rising strain, between points by straight lines.
double stress_at(const Curve& curve, double strain) {
  const auto after = std::lower_bound(curve.strain.begin(), curve.strain.end(), strain);
  if (after == curve.strain.begin()) return curve.stress.front();
  if (after == curve.strain.end()) return curve.stress.back();
  const auto k = static_cast<std::size_t>(after - curve.strain.begin());
  const double share = (strain - curve.strain[k - 1]) / (curve.strain[k] - curve.strain[k - 1]);
  return (1.0 - share) * curve.stress[k - 1] + share * curve.stress[k];
}

/// First strain at which a curve reaches a stress.
double strain_at(const Curve& curve, double stress) {
  for (std::size_t k = 1; k < curve.stress.size(); ++k)
    if (curve.stress[k - 1] < stress && curve.stress[k] >= stress)
      return curve.strain[k - 1] + (curve.strain[k] - curve.strain[k - 1]) * (stress - curve.stress[k - 1]) /
                                       (curve.stress[k] - curve.stress[k - 1]);
  return curve.strain.front();
}

std::optional<dem_core::CurveFeatures> landmarks(const Curve& smooth) {
  std::vector<CurveRow> rows;
  for (std::size_t k = 0; k < smooth.strain.size(); ++k) {
    CurveRow row;
    row.strain = smooth.strain[k], row.stress = smooth.stress[k];
    rows.push_back(row);
  }
  return dem_core::curve_features(rows);
}

class Features {
 public:
  void difference(const std::string& name, double value, double from, double to) {
    all_.push_back({name, false, value, from, to});
  }
  void logarithm(const std::string& name, double value, double from, double to) {
    if (value > 0.0 && std::isfinite(value)) all_.push_back({name, true, value, from, to});
  }
  std::vector<CurveFeature> take() { return std::move(all_); }

 private:
  std::vector<CurveFeature> all_;
};

void add_loading(Features& features, const Curve& smooth, const dem_core::CurveFeatures& at) {
  const double toe = at.toe_strain, end = at.fit_to, last = smooth.strain.back();
  features.difference("toe_strain", toe, smooth.strain.front(), at.fit_from);
  features.logarithm("toe_roundness", stress_at(smooth, toe) / (0.01 * at.modulus), smooth.strain.front(),
                     toe);
  const double fifth = 0.2 * stress_at(smooth, end);
  const double half_way = strain_at(smooth, 0.5 * fifth), way = strain_at(smooth, fifth);
  if (way > half_way) features.logarithm("early_modulus", 0.5 * fifth / (way - half_way), half_way, way);
  features.logarithm("linear_modulus", at.modulus, at.fit_from, at.fit_to);
  if (at.linear_limit)
    features.difference("linear_limit", *at.linear_limit, at.fit_to, toe + *at.linear_limit);
  if (!at.peak_passed) return;
  const double peak = toe + at.peak_strain;
  features.difference("peak_strain", at.peak_strain, at.fit_to, peak);
  features.logarithm("peak_stress", at.peak_stress, at.fit_to, peak);
  if (peak + 0.02 <= last)
    features.logarithm("softening", stress_at(smooth, peak + 0.02) / at.peak_stress, peak, peak + 0.02);
}

void add_loop(Features& features, const Curve& curve, const Loop& loop, double toe,
              const std::string& suffix) {
  const double start = curve.stress[loop.top], top = curve.strain[loop.top],
               bottom = curve.strain[loop.bottom];
  std::vector<double> strain, stress;
  double residual = bottom, area = 0.0;
  for (std::size_t k = loop.top; k <= loop.bottom; ++k) {
    if (curve.stress[k] <= 0.95 * start && curve.stress[k] >= 0.5 * start)
      strain.push_back(curve.strain[k]), stress.push_back(curve.stress[k]);
    if (curve.stress[k] >= 0.1 * start) residual = curve.strain[k];
  }
  if (strain.size() < 3) return;
  const double modulus = line_through(strain, stress).slope;
  features.logarithm("unloading_modulus" + suffix, modulus, strain.back(), strain.front());
  features.difference("residual_strain" + suffix, residual - toe, bottom, top);
  if (loop.end >= curve.strain.size() || modulus <= 0.0) return;
  for (std::size_t k = loop.top + 1; k <= loop.end; ++k)
    area += 0.5 * (curve.stress[k] + curve.stress[k - 1]) * (curve.strain[k] - curve.strain[k - 1]);
  features.logarithm("loop_area" + suffix, area / (0.5 * start * start / modulus), bottom, top);
}

}  // namespace

std::vector<Loop> loops_of(const Curve& curve, double last_strain) {
  std::vector<Loop> loops;
  std::size_t top = 0;
  for (std::size_t k = 1; k < curve.strain.size() && curve.strain[top] <= last_strain; ++k) {
    if (curve.strain[k] >= curve.strain[top]) {
      top = k;
      continue;
    }
    std::size_t bottom = k, end = k;
    while (end < curve.strain.size() && curve.strain[end] < curve.strain[top]) {
      if (curve.strain[end] < curve.strain[bottom]) bottom = end;
      ++end;
    }
    // Where strain is read with a compliant machine it also jumps back when the specimen fails.
    const bool long_enough = curve.strain[top] - curve.strain[bottom] >= kLeastUnloading;
    if (long_enough && curve.stress[bottom] <= kUnloaded * curve.stress[top])
      loops.push_back({top, bottom, end});
    k = end;
    if (end < curve.strain.size()) top = end;
  }
  return loops;
}

std::vector<CurveFeature> curve_features(const Curve& curve, double last_strain) {
  const Curve envelope = envelope_of(curve, last_strain);
  if (envelope.strain.size() < 8) return {};
  const Curve smooth = smoothed(envelope);
  const auto at = landmarks(smooth);
  if (!at) return {};
  Features features;
  add_loading(features, smooth, *at);
  int number = 0;
  for (const auto& loop : loops_of(curve, last_strain))
    add_loop(features, curve, loop, at->toe_strain, ++number == 1 ? "" : fmt::format("_{}", number));
  return features.take();
}

std::vector<double> unloading_strains(const Curve& curve) {
  std::vector<double> strains;
  for (const auto& loop : loops_of(curve, std::numeric_limits<double>::infinity()))
    strains.push_back(curve.strain[loop.top]);
  return strains;
}

double curve_noise(const Curve& curve) {
  // Of three neighbours the middle one's distance from the line through the others has 1.5 times the
  // variance.
  const Curve envelope = envelope_of(
      curve, curve.strain.empty() ? 0.0 : *std::max_element(curve.strain.begin(), curve.strain.end()));
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k + 1 < envelope.strain.size(); ++k) {
    const double share =
        (envelope.strain[k] - envelope.strain[k - 1]) / (envelope.strain[k + 1] - envelope.strain[k - 1]);
    const double straight = (1.0 - share) * envelope.stress[k - 1] + share * envelope.stress[k + 1];
    const double variance = 1.0 + share * share + (1.0 - share) * (1.0 - share);
    sum += std::pow(envelope.stress[k] - straight, 2) / variance;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace pendular::diagnosis
