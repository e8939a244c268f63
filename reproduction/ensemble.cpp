#include "reproduction/ensemble.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/csv.h"
#include "base/line_fit.h"

namespace pendular::reproduction {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kSlopeFrom = 0.02, kSlopeTo = 0.03;  // platen strain

}  // namespace

std::vector<Point> read_points(const sweep::Plan& plan, std::span<const sweep::RunOutcome> outcomes) {
  std::vector<Point> points;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    points.resize(plan.runs[k].point);
    Point& point = points.back();
    point.sample = plan.requests[k].sample;
    if (outcomes[k].status != sweep::RunStatus::done) continue;
    point.requests.push_back(plan.requests[k]);
    point.runs.push_back(read_run_curves(outcomes[k].folder));
  }
  return points;
}

Spread spread_of(std::span<const double> values) {
  Spread spread;
  double sum = 0.0, square = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) sum += v, ++spread.count;
  const double n = static_cast<double>(spread.count);
  if (spread.count > 0) spread.mean = sum / n;
  for (const double v : values)
    if (std::isfinite(v)) square += (v - spread.mean) * (v - spread.mean);
  if (spread.count > 1) spread.sd = std::sqrt(square / (n - 1.0));
  return spread;
}

Spread spread_of(const Point& point, Quantity quantity) {
  std::vector<double> values;
  for (const auto& run : point.runs) values.push_back(quantity(run));
  return spread_of(values);
}

double modulus(const RunFolder& run) {
  return run.result.modulus.value_or(kNone);
}

double linear_limit(const RunFolder& run) {
  return run.result.linear_limit.value_or(kNone);
}

double peak_strain(const RunFolder& run) {
  return run.result.peak_strain.value_or(kNone);
}

double peak_stress(const RunFolder& run) {
  return run.result.peak_stress.value_or(kNone);
}

double coordination_number(const RunFolder& run) {
  return run.result.coordination.value_or(kNone);
}

double broken_share_before_limit(const RunFolder& run) {
  if (!run.result.linear_limit || !run.result.bonds) return kNone;
  const double end = run.result.toe + *run.result.linear_limit;
  const auto broken = std::upper_bound(run.break_strain.begin(), run.break_strain.end(), end);
  return static_cast<double>(broken - run.break_strain.begin()) / static_cast<double>(*run.result.bonds);
}

double stress_kept(const RunFolder& run) {
  return run.stress.back() / *std::max_element(run.stress.begin(), run.stress.end());
}

double band_contrast(const RunFolder& run) {
  return run.result.band ? run.result.band->contrast : kNone;
}

double volume_change_at_peak(const RunFolder& run) {
  const auto lateral = read_csv(run.path / "curve.csv", {"lateral_strain"}).numbers("lateral_strain", true);
  const auto peak = std::max_element(run.stress.begin(), run.stress.end()) - run.stress.begin();
  const auto row = static_cast<std::size_t>(peak);
  return 2.0 * lateral[row] - run.strain[row];
}

double slope_at_fixed_strain(const RunFolder& run) {
  std::vector<double> strain, stress;
  for (std::size_t k = 0; k < run.strain.size(); ++k) {
    if (run.strain[k] < kSlopeFrom || run.strain[k] > kSlopeTo) continue;
    strain.push_back(run.strain[k]), stress.push_back(run.stress[k]);
  }
  return strain.size() > 2 ? line_through(strain, stress).slope : kNone;
}

std::string in_words(const Spread& spread, double unit, int decimals) {
  if (spread.count == 0) return "–";
  const std::string mean = fmt::format("{:.{}f}", spread.mean / unit, decimals);
  return spread.count > 1 ? fmt::format("{} ± {:.{}f}", mean, spread.sd / unit, decimals) : mean;
}

}  // namespace pendular::reproduction
