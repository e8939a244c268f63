#include <algorithm>

#include "effects/effect.h"
#include "effects/weakening.h"

namespace pendular::effects {
namespace {

constexpr double kLostAtEnd = 0.9;

std::function<void(const dem_core::BondMoment&)> evolution(const ActualSpecimen&, double theta) {
  return [theta](const dem_core::BondMoment& bond) {
    const double life = std::min(griffith_length(bond) / std::sqrt(bond.properties.break_limit), 1.0);
    const double lost = kLostAtEnd * std::max(0.0, (life - (1.0 - theta)) / theta);
    weaken(bond, std::max(lost, bond.memory[0]), bond.memory[0]);
  };
}

}  // namespace

/// The paper's bonds keep their stiffness until they break. Real ones tear off bit by bit: over the last
/// share θ of its life a bond's stiffness falls linearly from all to a tenth. Life is the length of
/// Griffith's criterion, √(Δr_n² + |δt|²/12), over that at which the bond breaks; what is lost stays lost.
/// Lowers the peak. What it does to E and to unloading has not been measured.
Effect bond_damage() {
  return {.id = "bond_damage",
          .unit = "fraction",
          .name = "bridges that weaken before they break",
          .sentence = "A bridge loses stiffness over the last part of its life before it breaks.",
          .meaning = "share of its life over which a bond weakens before it breaks",
          .lowest = 0.0,
          .highest = 1.0,
          .bank_from = 0.0,
          .bank_to = 0.9,
          .evolution = evolution,
          .memory = 1};
}

}  // namespace pendular::effects
