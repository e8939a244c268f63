#include "effects/effect.h"
#include "micromechanics/stiffness.h"

namespace pendular::effects {
namespace {

void stiffen(dem_core::Simulation& simulation, const ActualSpecimen& specimen, double theta, const Draws&) {
  const auto bonds =
      micromechanics::bridge_stiffnesses(specimen.bodies, micromechanics::polymer_of(specimen.sample)).bonds;
  simulation.law.bending = true;
  for (auto& pair : simulation.pairs) {
    if (pair.bond < 0) continue;
    pair.properties.k_bend = theta * bonds[static_cast<std::size_t>(pair.bond)].bending;
    pair.properties.k_twist = theta * bonds[static_cast<std::size_t>(pair.bond)].twisting;
  }
}

}  // namespace

/// The paper's bonds resist no bending and no twisting. Real bridges do: θ = 1 is what finite elements give
/// for each bridge's body. Raises E.
Effect bridge_bending() {
  return {.id = "bridge_bending",
          .unit = "multiple",
          .name = "bridges that resist bending",
          .sentence = "Bridges resist bending and twisting, which the model's bonds do not.",
          .meaning = "bending and twisting stiffness over that by finite elements",
          .lowest = 0.0,
          .highest = 5.0,
          .bank_from = 0.0,
          .bank_to = 2.0,
          .simulation = stiffen};
}

}  // namespace pendular::effects
