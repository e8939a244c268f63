#include "segmentation/fit/ball_profile.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pendular::segmentation {
namespace {

/// Normal distribution and density on a grid fine enough for linear interpolation to 1e-7: the fits spend
/// most of their time on these two.
class NormalTable {
 public:
  NormalTable() {
    for (int k = 0; k <= 2 * reach * per_unit + 1; ++k) {
      const double t = static_cast<double>(k) / per_unit - reach;
      nodes_.push_back(
          {0.5 * std::erfc(-t * M_SQRT1_2), std::exp(-0.5 * t * t) * 0.5 * M_SQRT1_2 * M_2_SQRTPI});
    }
  }

  struct Node {
    double cumulative, density;
  };
  Node operator()(double t) const {
    const double place = (std::clamp(t, -double{reach}, double{reach}) + reach) * per_unit;
    const auto k = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(k);
    const Node &a = nodes_[k], &b = nodes_[k + 1];
    return {a.cumulative + share * (b.cumulative - a.cumulative),
            a.density + share * (b.density - a.density)};
  }

 private:
  static constexpr int reach = 7, per_unit = 512;
  std::vector<Node> nodes_;
};

}  // namespace

BallProfile ball_profile(double r, double R, double s) {
  static const NormalTable normal;
  const double per_s = 1.0 / s, per_r = 1.0 / r;
  const double t = (R - r) * per_s;
  const auto [cumulative, density] = normal(t);
  const double curvature = s * per_r;
  BallProfile profile;
  profile.value = cumulative - curvature * density;
  profile.by_radius = density * per_s * (1.0 + curvature * t);
  profile.by_distance = -profile.by_radius + curvature * per_r * density;
  profile.by_blur = -density * (t * per_s + (1.0 + t * t) * per_r);
  return profile;
}

}  // namespace pendular::segmentation
