#include "blind/proportion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pendular::blind {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double Proportion::share() const {
  return of > 0 ? static_cast<double>(hits) / static_cast<double>(of) : kNone;
}

std::pair<double, double> Proportion::interval_95() const {
  if (of == 0) return {0.0, 1.0};
  constexpr double z = 1.959964;
  const double n = static_cast<double>(of), p = share(), zz = z * z / n;
  const double middle = p + 0.5 * zz, half = z * std::sqrt(p * (1.0 - p) / n + 0.25 * zz / n);
  return {std::max(0.0, (middle - half) / (1.0 + zz)), std::min(1.0, (middle + half) / (1.0 + zz))};
}

double area_under_curve(const std::vector<double>& positives, const std::vector<double>& negatives) {
  if (positives.empty() || negatives.empty()) return kNone;
  double above = 0.0;
  for (double p : positives)
    for (double n : negatives) above += p > n ? 1.0 : p == n ? 0.5 : 0.0;
  return above / static_cast<double>(positives.size() * negatives.size());
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace pendular::blind
