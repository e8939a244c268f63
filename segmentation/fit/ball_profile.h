#pragma once

namespace pendular::segmentation {

/// A ball of radius R, 1 inside and 0 outside, seen through a Gaussian point spread of standard deviation s,
/// at the distance r from its centre, and its derivatives. Exact but for terms of order exp(−2R²/s²): P =
/// Φ(t) − (s/r) φ(t), t = (R − r)/s, with the normal distribution Φ and density φ. The second term is the
/// curvature of the ball; without it R would come out too small by about s²/R.
struct BallProfile {
  double value = 0.0;
  double by_radius = 0.0;    ///< ∂P/∂R
  double by_distance = 0.0;  ///< ∂P/∂r
  double by_blur = 0.0;      ///< ∂P/∂s
};

BallProfile ball_profile(double r, double R, double s);

}  // namespace pendular::segmentation
