#include <algorithm>
#include <cmath>

#include "blind/mechanism.h"
#include "packing/bridges.h"

namespace pendular::blind {
namespace {

void wrap(Packing& packing, double theta) {
  const auto& cylinder = packing.specimen;
  const double diameter = mean_diameter(packing.beads);
  const auto outside = [&](int k) {
    const Vec3& p = packing.beads[k].centre;
    return std::hypot(p.x() - cylinder.axis_x, p.y() - cylinder.axis_y) >
           0.5 * cylinder.diameter - 0.9 * diameter;
  };
  const auto pair = [](const Bridge& bridge) { return std::pair(bridge.i, bridge.j); };
  const auto less = [&](const Bridge& a, const Bridge& b) { return pair(a) < pair(b); };
  std::vector<Bridge> skin = candidate_bridges(packing.beads, theta * diameter);
  std::erase_if(skin, [&](const Bridge& bridge) {
    return !outside(bridge.i) || !outside(bridge.j) ||
           std::binary_search(packing.bridges.begin(), packing.bridges.end(), bridge, less);
  });
  for (auto& bridge : skin) bridge.state = BridgeState::bridge;
  packing.bridges.insert(packing.bridges.end(), skin.begin(), skin.end());
  std::sort(packing.bridges.begin(), packing.bridges.end(), less);
}

}  // namespace

/// A skin of polymer was left by the mould and holds the specimen together: beads at its side are joined, as
/// by bridges, also to neighbours as far as θ. Raises E and the peak.
Mechanism sleeve() {
  return {.id = "sleeve",
          .kind = "loading",
          .unit = "bead diameters",
          .meaning = "gap up to which a skin joins the beads at the side",
          .from = 0.3,
          .to = 0.6,
          .packing = wrap};
}

}  // namespace pendular::blind
