#include "effects/effect.h"

namespace pendular::effects {
namespace {

void widen(Packing& packing, double by) {
  for (auto& bead : packing.beads) bead.diameter += by;
  for (auto& bridge : packing.bridges) bridge.gap -= by;
}

void sample(Sample& sample, double theta) {
  sample.beads.diameter -= 1e-6 * theta;
}

void truth(Packing& packing, double theta, const Draws&) {
  widen(packing, -1e-6 * theta);
}

void reading(Packing& packing, double theta, const Draws&) {
  widen(packing, 1e-6 * theta);
}

}  // namespace

/// The paper takes diameters as measured. A threshold set too low makes all beads larger: the true diameters,
/// and their mean, are smaller by θ, and gaps wider. Contacts close later or never. Lowers E; with drawn
/// diameters, Z too, because fewer pairs are closer than the cut-off.
Effect diameter_bias() {
  return {.id = "diameter_bias",
          .unit = "um",
          .meaning = "by how much measured bead diameters are too large",
          .lowest = -10.0,
          .highest = 10.0,
          .bank_from = -4.0,
          .bank_to = 4.0,
          .sample = sample,
          .truth = truth,
          .reading = reading};
}

}  // namespace pendular::effects
