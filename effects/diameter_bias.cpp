#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

constexpr double kUm = 1e6;

void beads(std::vector<Bead>& beads, double theta) {
  for (auto& bead : beads) bead.diameter -= 1e-6 * theta;
}

void shrink(Packing& packing, double theta) {
  beads(packing.beads, theta);
  for (auto& bridge : packing.bridges) bridge.gap += 1e-6 * theta;
}

void sample(Sample& sample, double theta) {
  sample.beads.diameter -= 1e-6 * theta;
}

void truth(Packing& packing, double theta, const Draws&) {
  shrink(packing, theta);
}

void reading(Packing& packing, double theta, const Draws&) {
  shrink(packing, -theta);
}

/// Diameters too large by θ draw the peak to −θ.
void contacts(ContactPeak& peak, double theta) {
  peak.position -= theta / kUm;
}

std::optional<double> shown_by_beads(const ContactPeak& peak) {
  if (std::fabs(peak.position) <= kTouchingGap * peak.diameter) return std::nullopt;
  return -kUm * peak.position;
}

}  // namespace

/// The paper takes diameters as measured. A threshold set too low makes all beads larger: the true diameters,
/// and their mean, are smaller by θ, and gaps wider. Contacts close later or never. Lowers E; with drawn
/// diameters, Z too, because fewer pairs are closer than the cut-off.
Effect diameter_bias() {
  return {.id = "diameter_bias",
          .unit = "um",
          .name = "biased bead diameters",
          .sentence = "All measured bead diameters are too large; too small where the magnitude is negative.",
          .meaning = "by how much measured bead diameters are too large",
          .lowest = -10.0,
          .highest = 10.0,
          .bank_from = -4.0,
          .bank_to = 4.0,
          .settled_by = calibration_sphere(),
          .contacts = contacts,
          .shown_by_beads = shown_by_beads,
          .sample = sample,
          .beads = beads,
          .truth = truth,
          .reading = reading};
}

}  // namespace pendular::effects
