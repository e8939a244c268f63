#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pendular::segmentation {

/// A ball of radius R, 1 inside and 0 outside, seen through a Gaussian point spread of standard deviation s,
/// at the distance r from its centre, and its derivatives. Exact but for terms of order exp(−2R²/s²): P =
/// Φ(t) − (s/r) φ(t), t = (R − r)/s, with the normal distribution Φ and density φ. The second term is the
/// curvature of the ball; without it R would come out too small by about s²/R.
template <typename Number>
struct BallProfileOf {
  Number value{};
  Number by_radius{};    ///< ∂P/∂R
  Number by_distance{};  ///< ∂P/∂r
  Number by_blur{};      ///< ∂P/∂s
};
using BallProfile = BallProfileOf<double>;

BallProfile ball_profile(double r, double R, double s);

/// Normal distribution and density on a grid fine enough for linear interpolation to 1e-7: the fits spend
/// most of their time on these two.
class NormalTable {
 public:
  struct Node {
    double cumulative, density;
  };
  static constexpr int kReach = 7, kPerUnit = 512;

  NormalTable();

  /// The two nodes from this one on are those to the left and to the right of t = place / kPerUnit − kReach.
  const Node* at(std::size_t place) const { return &nodes_[place]; }

 private:
  std::array<Node, 2 * kReach * kPerUnit + 2> nodes_;
};
const NormalTable& normal_table();

/// The profile from Φ and φ at t. Of doubles and, always inlined, of the compiler's vectors of them.
template <typename Number>
inline __attribute__((always_inline)) void set_profile(const Number& r, double s, const Number& t,
                                                       const Number& cumulative, const Number& density,
                                                       BallProfileOf<Number>& profile) {
  const double per_s = 1.0 / s;
  const Number per_r = 1.0 / r, curvature = s * per_r;
  profile.value = cumulative - curvature * density;
  profile.by_radius = density * per_s * (1.0 + curvature * t);
  profile.by_distance = -profile.by_radius + curvature * per_r * density;
  profile.by_blur = -density * (t * per_s + (1.0 + t * t) * per_r);
}

}  // namespace pendular::segmentation
