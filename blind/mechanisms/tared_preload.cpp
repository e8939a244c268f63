#include <algorithm>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void tare(std::vector<CurveRow>& rows, const dem_core::Simulation& simulation, double theta) {
  const double preload = theta / simulation.section;
  const auto start =
      std::find_if(rows.begin(), rows.end(), [&](const CurveRow& row) { return row.stress > preload; });
  if (start == rows.end()) return;
  const CurveRow zero = *start;
  rows.erase(rows.begin(), start);
  for (auto& row : rows) {
    row.strain -= zero.strain;
    row.stress -= zero.stress;
    row.lateral_strain -= zero.lateral_strain;
    row.broken_bonds -= zero.broken_bonds;
  }
}

}  // namespace

/// All readings were set to zero when the specimen already carried the force θ. Takes the toe away and lowers
/// the peak and the strains.
Mechanism tared_preload() {
  return {.id = "tared_preload",
          .kind = "bookkeeping",
          .unit = "N",
          .meaning = "force that was counted as zero",
          .from = 0.4,
          .to = 1.2,
          .rows = tare};
}

}  // namespace pendular::blind
