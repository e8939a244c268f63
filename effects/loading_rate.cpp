#include "effects/effect.h"

namespace pendular::effects {
namespace {

void change(Sample& sample, double theta) {
  auto& asked = sample.compression;
  (asked.speed_si ? *asked.speed_si : asked.speed) *= theta;
  if (asked.control == Control::relaxation) asked.control = Control::speed;
}

}  // namespace

/// The paper's simulation is faster than its experiment, and both are taken to be quasi-static. θ is the
/// speed of the run over the stated one; 0 and, where the platen is driven by its speed, 1 are as stated. A
/// sample that compresses in increments at rest runs at θ times its compression.speed instead.
/// Beads have mass: kinetic energy grows as θ². What it does to E and the peak has not been measured.
Effect loading_rate() {
  return {.id = "loading_rate",
          .unit = "ratio",
          .name = "loading faster than stated",
          .sentence = "The specimen is loaded faster than stated, so that inertia counts.",
          .meaning = "speed of the run over the stated one",
          .lowest = 0.0,
          .highest = 100.0,
          .bank_from = 0.0,
          .bank_to = 10.0,
          .settled_by = DirectMeasurement{"the simulation at half the speed",
                                          "the only one that needs no experiment", 0.1},
          .sample = change};
}

}  // namespace pendular::effects
