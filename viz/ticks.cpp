#include "viz/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pendular::viz {

Ticks round_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / wanted, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (double factor : {5.0, 2.0, 1.0})
    if (factor * power >= 0.999 * rough) step = factor * power;
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  Ticks ticks;
  for (double k = std::ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; k += 1.0) {
    ticks.values.push_back(k * step);
    ticks.labels.push_back(fmt::format("{:.{}f}", k == 0.0 ? 0.0 : k * step, decimals));
  }
  return ticks;
}

}  // namespace pendular::viz
