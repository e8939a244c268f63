#include <algorithm>
#include <limits>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

constexpr double kNoPlaten = 1.0;  // m: farther than any bead comes

void shift(dem_core::Simulation& simulation, double theta) {
  const auto& at = simulation.beads.position;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const auto& p : at) left = std::min(left, p.x()), right = std::max(right, p.x());
  const double edge = right - theta * (right - left);
  for (std::size_t k = 0; k < at.size(); ++k)
    if (at[k].x() > edge) simulation.top.relief[k] += kNoPlaten;
  dem_core::place_platens(simulation, simulation.bottom.velocity);
  dem_core::list_pairs(simulation);
}

}  // namespace

/// The specimen stands off centre: over the share θ of its width there is no top platen. Lowers E and the
/// peak.
Mechanism platen_overhang() {
  return {.id = "platen_overhang",
          .kind = "loading",
          .unit = "fraction",
          .meaning = "share of the width that the top platen does not cover",
          .from = 0.15,
          .to = 0.4,
          .simulation = shift};
}

}  // namespace pendular::blind
