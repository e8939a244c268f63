#include <algorithm>
#include <cmath>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void average(std::vector<CurveRow>& rows, const dem_core::Simulation&, double theta) {
  if (rows.size() < 2) return;
  const double step = std::fabs(rows[1].strain - rows[0].strain);  // rows are equal times
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(theta / step)));
  std::vector<double> sums = {0.0};
  for (const auto& row : rows) sums.push_back(sums.back() + row.stress);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t last = k + 1, first = last > window ? last - window : 0;
    rows[k].stress = (sums[last] - sums[first]) / static_cast<double>(window);
  }
}

}  // namespace

/// The amplifier averages over the time in which the platen makes the strain θ, the logger notes strains as
/// they are: stress comes late. Lengthens the toe, rounds the peak and the turns.
Mechanism slow_logger() {
  return {.id = "slow_logger",
          .kind = "bookkeeping",
          .unit = "strain",
          .meaning = "strain made during the time over which the force is averaged",
          .from = 0.004,
          .to = 0.01,
          .rows = average};
}

}  // namespace pendular::blind
