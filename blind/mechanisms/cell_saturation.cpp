#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void saturate(std::vector<CurveRow>& rows, const dem_core::Simulation& simulation, double theta) {
  for (auto& row : rows) row.stress /= 1.0 + theta * row.stress * simulation.section;
}

}  // namespace

/// The load cell is too small: it reads F/(1 + θ F). Lowers the peak and the slope before it.
Mechanism cell_saturation() {
  return {.id = "cell_saturation",
          .kind = "instrument",
          .unit = "1/N",
          .meaning = "loss of the load cell's gain per newton",
          .from = 0.04,
          .to = 0.12,
          .rows = saturate};
}

}  // namespace pendular::blind
