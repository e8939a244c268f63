#include "effects/effect.h"

namespace pendular::effects {
namespace {

void read(std::vector<CurveRow>& rows, const Gauge& gauge, double theta) {
  for (auto& row : rows) row.strain += 1e-6 * theta * row.stress * gauge.section / gauge.height;
}

}  // namespace

/// The paper's platens move as far as the machine says. A real machine gives way: its reading is the
/// specimen's shortening and θ times the force. Strains that are measured in a tomogram, and those of the
/// run's events and frames, do not have it. Lowers E: 1/E grows by θ A/L.
Effect machine_compliance() {
  return {.id = "machine_compliance",
          .unit = "um/N",
          .name = "compliance of the testing machine",
          .sentence = "The machine gives way under load, which is read as strain of the specimen.",
          .meaning = "compliance in series with the specimen",
          .lowest = 0.0,
          .highest = 1e4,
          .bank_from = 0.0,
          .bank_to = 10.0,
          .settled_by = DirectMeasurement{"the platens pressed on a steel block",
                                          "the compliance of frame and load cell by itself", 0.2},
          .rows = read};
}

}  // namespace pendular::effects
