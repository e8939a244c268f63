#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

void change(dem_core::Simulation& simulation, const ActualSpecimen&, double theta, const Draws& draws) {
  const double spread = 0.5 * std::fabs(theta);
  for (auto& pair : simulation.pairs)
    if (pair.bond >= 0)
      pair.properties.break_limit *=
          (1.0 + theta) * std::exp(spread * draws.normal(of_pair(pair.i, pair.j)) - 0.5 * spread * spread);
}

}  // namespace

/// The paper gives all interfaces the same energy G. Real ones have another and no single one: that of each
/// bond is G (1 + θ) times a log-normal number of mean 1 and logarithmic spread |θ|/2, so that the mean is
/// G (1 + θ). θ < 0 lowers the linear limit and the peak; E stays.
Effect interface_strength() {
  return {.id = "interface_strength",
          .unit = "fraction",
          .name = "interface strength other than stated",
          .sentence = "Polymer adheres to glass more or less strongly than stated, and not everywhere alike.",
          .meaning = "relative change of the mean interfacial energy, with a spread of half of it",
          .lowest = -0.9,
          .highest = 2.0,
          .bank_from = -0.6,
          .bank_to = 0.6,
          .draws = true,
          .simulation = change};
}

}  // namespace pendular::effects
