#include <algorithm>

#include "effects/effect.h"
#include "effects/weakening.h"

namespace pendular::effects {
namespace {

constexpr double kLargestLoss = 0.95;

std::function<void(const dem_core::BondMoment&)> evolution(const ActualSpecimen&, double theta) {
  return [theta](const dem_core::BondMoment& bond) {
    const double strain = griffith_length(bond) / bond.height;
    weaken(bond, std::min(0.5 * theta * strain, kLargestLoss), bond.memory[0]);
  };
}

}  // namespace

/// The paper's polymer is linear elastic at any strain. A real one softens: a bridge's tangent stiffness is
/// 1 − θ ε of the stated one, ε its strain, so that its secant stiffness, which the simulation changes as the
/// test goes on, is 1 − θ ε/2, and no less than 5 % of the stated. ε = √(Δr_n² + |δt|²/12)/l, as Griffith's
/// criterion measures it; it acts in tension and compression alike and goes back with the strain. Lowers the
/// slope the more the farther the test has come, and the peak; θ < 0 stiffens.
Effect polymer_nonlinearity() {
  return {
      .id = "polymer_nonlinearity",
      .unit = "per strain",
      .name = "polymer that softens with strain",
      .sentence =
          "The polymer's stiffness falls as a bridge is strained; it rises where the magnitude is negative.",
      .meaning = "loss of a bridge's tangent stiffness per unit of its strain",
      .lowest = -3.0,
      .highest = 5.0,
      .bank_from = -0.5,
      .bank_to = 1.5,
      .evolution = evolution,
      .memory = 1};
}

}  // namespace pendular::effects
