#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

// Over D. A longer bridge carries next to nothing, and finite elements would have to be tabulated for it.
constexpr double kLongest = 0.2;

void spread(micromechanics::BridgeBody& body, const Sample& sample, double theta, const Draws& draws,
            std::uint64_t pair) {
  const double excess = -1e-6 * theta * std::log(draws.uniform(pair));
  body.gap = std::min(body.gap + excess, std::max(body.gap, kLongest * sample.beads.diameter));
}

void single_bridges(BridgeSpread& spread, double theta) {
  spread.gap_excess += theta;
}

}  // namespace

/// The paper gives all bridges the stiffness of one that spans 2 µm. Real ones span more: each gap is the
/// stated one and an exponential excess of mean θ, cut at a fifth of D. Longer bridges are softer and break
/// later. Lowers E; Z stays.
Effect bridge_gap_spread() {
  return {
      .id = "bridge_gap_spread",
      .unit = "um",
      .name = "bridges longer than stated",
      .sentence = "Bridges span wider gaps than the one for which their stiffness is stated, and are softer.",
      .meaning = "mean excess gap of the bridges over the one for which the stiffness is stated",
      .lowest = 0.0,
      .highest = 20.0,
      .bank_from = 0.0,
      .bank_to = 6.0,
      .draws = true,
      .single_bridges = single_bridges,
      .body = spread};
}

}  // namespace pendular::effects
