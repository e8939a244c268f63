#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

constexpr double kUm = 1e6;

void beads(std::vector<Bead>& beads, double theta) {
  for (auto& bead : beads) bead.sigma_centre = std::hypot(bead.sigma_centre, 1e-6 * theta);
}

void move(Packing& packing, double way, const Draws& draws) {
  for (std::size_t k = 0; k < packing.beads.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      packing.beads[k].centre[static_cast<int>(axis)] += way * draws.normal(3 * k + axis);
  for (auto& bridge : packing.bridges) bridge.gap = gap(packing.beads[bridge.i], packing.beads[bridge.j]);
}

void truth(Packing& packing, double theta, const Draws& draws) {
  move(packing, 1e-6 * theta, draws);
  beads(packing.beads, theta);
}

void reading(Packing& packing, double theta, const Draws& draws) {
  move(packing, -1e-6 * theta, draws);
}

/// Noise θ of centres that is not stated adds 2θ² to the peak's variance.
void contacts(ContactPeak& peak, double theta) {
  peak.scatter = std::hypot(peak.scatter, M_SQRT2 * (theta / kUm));
}

std::optional<double> shown_by_beads(const ContactPeak& peak) {
  const double excess = peak.scatter * peak.scatter - peak.stated * peak.stated;
  const double own = kTouchingScatter * peak.diameter;
  if (peak.stated <= 0.0 || excess <= own * own) return std::nullopt;
  return kUm * std::sqrt(0.5 * excess);
}

}  // namespace

/// The paper simulates the beads where the tomogram shows them. They are elsewhere, by N(0, θ) along each
/// axis: measured centres are those that are, and noise that was not reported. Which pairs touch changes, not
/// which are bridged. Overlaps that it makes are at rest. Measured diameters keep their bridges; drawn ones
/// are drawn for the beads where they are, which leaves smaller beads and lowers E and Z.
Effect position_error() {
  return {.id = "position_error",
          .unit = "um",
          .name = "unreported error of bead positions",
          .sentence = "Measured bead centres are less certain than stated.",
          .meaning = "unreported noise of the measured centres along each axis",
          .lowest = 0.0,
          .highest = 20.0,
          .bank_from = 0.0,
          .bank_to = 5.0,
          .draws = true,
          .contacts = contacts,
          .shown_by_beads = shown_by_beads,
          .beads = beads,
          .truth = truth,
          .reading = reading};
}

}  // namespace pendular::effects
