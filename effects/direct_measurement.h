#pragma once

#include <string>

namespace pendular::effects {

/// A measurement, not of a specimen, that finds the magnitude of an effect or rules it out.
struct DirectMeasurement {
  std::string name, why;
  double cost = 1.0;  ///< in units of one compression test
};

/// Those that settle more than one effect.
inline DirectMeasurement calibration_sphere() {
  return {"a calibration sphere scanned with the specimen",
          "voxel size and the threshold's bias by themselves", 0.3};
}
inline DirectMeasurement sliding_friction() {
  return {"sliding friction of two glued beads, and of a bead on the platen",
          "both coefficients by themselves", 0.5};
}

}  // namespace pendular::effects
