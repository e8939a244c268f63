#pragma once

#include <span>

#include "sweep/request.h"

namespace pendular::sweep {

/// Particle-steps per second of one thread, where the store has no run to take it from
/// (docs/performance.md: AVX2 makes 15.6 M on sample A; smaller specimens and older machines less).
constexpr double kStatedRate = 8e6;

/// What is needed to make some runs, by the sample's numbers alone: unloading, and platens that follow a ramp
/// of stress more slowly than they may, take longer.
struct Estimate {
  double particle_steps = 0.0;
  double bytes = 0.0;  ///< in the store
};
Estimate estimate(std::span<const RunRequest> requests);

}  // namespace pendular::sweep
