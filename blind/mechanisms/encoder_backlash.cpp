#include <algorithm>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void play(std::vector<CurveRow>& rows, const dem_core::Simulation& simulation, double theta) {
  const double width = 1e-6 * theta / simulation.initial_height;
  double read = 0.0;
  for (auto& row : rows) row.strain = read = std::clamp(read, row.strain, row.strain + width);
}

}  // namespace

/// The encoder sits behind a gear with play θ: where the platen turns it reads nothing until the play is
/// taken up. Raises the slope of unloading and widens the loop; loading is as it is.
Mechanism encoder_backlash() {
  return {.id = "encoder_backlash",
          .kind = "instrument",
          .unit = "um",
          .meaning = "play of the displacement's reading",
          .from = 4.0,
          .to = 12.0,
          .rows = play};
}

}  // namespace pendular::blind
