#include <algorithm>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void tare(std::vector<CurveRow>& rows, const Simulation&, double theta) {
  double highest = 0.0;
  for (const auto& row : rows) highest = std::max(highest, row.stress);
  const auto start = std::find_if(rows.begin(), rows.end(),
                                  [&](const CurveRow& row) { return row.stress > theta * highest; });
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

/// All readings were set to zero when the specimen already carried the share θ of its largest stress. Takes
/// the toe away and lowers the peak and the strains.
Mechanism tared_preload() {
  return {.id = "tared_preload",
          .kind = "bookkeeping",
          .unit = "fraction",
          .meaning = "share of the largest stress that was counted as zero",
          .from = 0.1,
          .to = 0.3,
          .rows = tare};
}

}  // namespace pendular::blind
