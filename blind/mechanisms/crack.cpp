#include <algorithm>
#include <limits>

#include "blind/mechanism.h"

namespace pendular::blind {
namespace {

void open_crack(Packing& packing, double theta) {
  double low = std::numeric_limits<double>::infinity(), high = -low, left = low, right = -low;
  for (const auto& bead : packing.beads) {
    low = std::min(low, bead.centre.z()), high = std::max(high, bead.centre.z());
    left = std::min(left, bead.centre.x()), right = std::max(right, bead.centre.x());
  }
  const double tip = left + theta * (right - left);
  const double middle_x = 0.5 * (left + right), middle_z = 0.5 * (low + high);
  const auto above = [&](const Vec3& p) { return p.z() - middle_z > p.x() - middle_x; };
  std::erase_if(packing.bridges, [&](const Bridge& bridge) {
    const Vec3 &a = packing.beads[bridge.i].centre, &b = packing.beads[bridge.j].centre;
    return above(a) != above(b) && 0.5 * (a.x() + b.x()) < tip;
  });
}

}  // namespace

/// The specimen was cracked before its test: no bridge crosses a plane at 45° through its middle, from one
/// side over the share θ of its width. Lowers the peak, and E a little.
Mechanism crack() {
  return {.id = "crack",
          .kind = "specimen",
          .unit = "fraction",
          .meaning = "share of the width that an inclined crack has cut",
          .from = 0.5,
          .to = 1.0,
          .packing = open_crack};
}

}  // namespace pendular::blind
