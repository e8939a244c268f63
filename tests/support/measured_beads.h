#pragma once

#include "base/random.h"
#include "base/sample.h"
#include "packing/generate.h"

namespace pendular::test {

inline constexpr double kBeadSigma = 0.3e-6;  ///< stated of centres and diameters, m

/// A specimen of some 250 beads, many of which touch.
inline Sample touching_sample() {
  return parse_sample(
      "[beads]\ndiameter_um = 200\ndiameter_sd_um = 2\ndiameters = \"measured\"\n"
      "[specimen]\ndiameter_um = 1300\nheight_um = 1300\nvolume_fraction = 0.58\n",
      "test");
}

inline const std::vector<Bead>& touching_beads() {
  static const std::vector<Bead> beads = generate_packing(touching_sample(), 7).beads;
  return beads;
}

/// As a tomogram shows them, with the errors that it states: centres off by those and `unreported` noise
/// along each axis, diameters too large by `bias` (m).
inline std::vector<Bead> measured_beads(double unreported = 0.0, double bias = 0.0) {
  std::vector<Bead> beads = touching_beads();
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] +=
          std::hypot(kBeadSigma, unreported) * random_normal(11, 4 * k + static_cast<std::size_t>(axis));
    beads[k].diameter += bias + kBeadSigma * random_normal(11, 4 * k + 3);
    beads[k].sigma_centre = beads[k].sigma_diameter = kBeadSigma;
  }
  return beads;
}

}  // namespace pendular::test
