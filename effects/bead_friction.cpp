#include <algorithm>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

void change(Sample& sample, double theta) {
  sample.contact.friction = std::max(0.0, sample.contact.friction + theta);
}

}  // namespace

/// The friction coefficient between beads is not what the sample states but larger by θ, and at least 0.
/// With θ < 0 the peak is lower. What it does to E has not been measured.
Effect bead_friction() {
  return {.id = "bead_friction",
          .unit = "1",
          .name = "bead friction other than stated",
          .sentence = "The friction coefficient between beads is not the stated one.",
          .meaning = "friction coefficient between beads less the stated one",
          .lowest = -2.0,
          .highest = 2.0,
          .bank_from = -0.4,
          .bank_to = 0.4,
          .settled_by = sliding_friction(),
          .sample = change};
}

}  // namespace pendular::effects
