#include <algorithm>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

void change(Sample& sample, double theta) {
  sample.contact.platen_friction = std::max(0.0, sample.contact.platen_friction + theta);
}

}  // namespace

/// The friction coefficient at the platens is not what the sample states but larger by θ, and at least 0.
/// With θ < 0 the peak is lower: beads on a smooth platen spread. What it does to E has not been measured.
Effect platen_friction() {
  return {.id = "platen_friction",
          .unit = "1",
          .name = "platen friction other than stated",
          .sentence = "The friction coefficient at the platens is not the stated one.",
          .meaning = "friction coefficient at the platens less the stated one",
          .lowest = -2.0,
          .highest = 2.0,
          .bank_from = -0.4,
          .bank_to = 0.4,
          .settled_by = sliding_friction(),
          .sample = change};
}

}  // namespace pendular::effects
