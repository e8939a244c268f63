#include "segmentation/fit/ball_profile.h"

#include <algorithm>

namespace pendular::segmentation {

NormalTable::NormalTable() {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const double t = static_cast<double>(k) / kPerUnit - kReach;
    nodes_[k] = {0.5 * std::erfc(-t * M_SQRT1_2), std::exp(-0.5 * t * t) * 0.5 * M_SQRT1_2 * M_2_SQRTPI};
  }
}

const NormalTable& normal_table() {
  static const NormalTable table;
  return table;
}

BallProfile ball_profile(double r, double R, double s) {
  static const NormalTable& normal = normal_table();
  const double t = (R - r) * (1.0 / s);
  const double place =
      (std::clamp(t, -double{NormalTable::kReach}, double{NormalTable::kReach}) + NormalTable::kReach) *
      NormalTable::kPerUnit;
  const auto k = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(k);
  const auto* node = normal.at(k);
  BallProfile profile;
  set_profile(r, s, t, node[0].cumulative + share * (node[1].cumulative - node[0].cumulative),
              node[0].density + share * (node[1].density - node[0].density), profile);
  return profile;
}

}  // namespace pendular::segmentation
