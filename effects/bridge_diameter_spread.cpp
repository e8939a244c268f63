#include <algorithm>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

// Over the mean neck: draws farther away count as that far, on both sides, so that the mean stays.
constexpr double kFarthest = 0.75;
constexpr double kThickest = 0.8;  // over D

void spread(micromechanics::BridgeBody& body, const Sample& sample, double theta, const Draws& draws,
            std::uint64_t pair) {
  const double d = body.neck_diameter, farthest = kFarthest * d;
  body.neck_diameter = std::min(d + std::clamp(1e-6 * theta * draws.normal(pair), -farthest, farthest),
                                std::max(d, kThickest * sample.beads.diameter));
}

void single_bridges(BridgeSpread& spread, double theta) {
  spread.diameter_sd = std::max(spread.diameter_sd, theta);
}

}  // namespace

/// The paper gives all bridges the stiffness of one of the mean diameter d. Real necks spread: each is
/// N(d, θ), no farther than 0.75 d from d. Lowers E slightly: kn grows slower than d, and a network of
/// unequal springs is softer than of their mean.
Effect bridge_diameter_spread() {
  return {.id = "bridge_diameter_spread",
          .unit = "um",
          .name = "spread of bridge diameters",
          .sentence = "Bridges differ in diameter, where the model gives all of them the mean one.",
          .meaning = "standard deviation of the bridges' diameters",
          .lowest = 0.0,
          .highest = 60.0,
          .bank_from = 0.0,
          .bank_to = 30.0,
          .draws = true,
          .single_bridges = single_bridges,
          .body = spread};
}

}  // namespace pendular::effects
