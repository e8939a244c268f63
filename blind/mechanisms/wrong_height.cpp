#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void divide(std::vector<CurveRow>& rows, const dem_core::Simulation&, double theta) {
  for (auto& row : rows) row.strain *= 1.0 - theta;
}

}  // namespace

/// Strain was computed over a height that holds the fixtures too: it is too small by the share θ. Raises E,
/// makes all strains smaller.
Mechanism wrong_height() {
  return {.id = "wrong_height",
          .kind = "bookkeeping",
          .unit = "fraction",
          .meaning = "by how much the noted strain is too small",
          .from = 0.1,
          .to = 0.25,
          .rows = divide};
}

}  // namespace pendular::blind
