#pragma once

#include <span>
#include <vector>

#include "segmentation/fit/ball_fit.h"

namespace pendular::segmentation {

/// Noise of the grey values, from the cores of the beads.
struct Noise {
  double sd = 0.0;                  ///< grey values
  std::vector<double> correlation;  ///< between voxels at distance k along an axis; [0] = 1
};

/// Pooled over the cores of at most some hundred of the balls, each less its own mean. `margin`: what of each
/// ball's outer part is not core, voxels. Without any core the sd is 0. `rings`, if any, are no noise.
Noise measure_noise(const Volume& volume, std::span<const GreyBall> balls, double margin,
                    const Rings* rings = nullptr);

/// Σ ρ over all lags, in voxels: by how much correlation raises the variance of a mean over many voxels; ρ
/// taken as isotropic.
double correlated_volume(const Noise& noise);

/// By how much correlation of the noise raises the variance of a fitted ball's centre and radius above what
/// independent noise of the same sd gives: Σ_uv J_u J_v ρ(|u − v|) / Σ_v J_v², with J the slope of the
/// profile over the shell and ρ taken as isotropic.
struct VarianceInflation {
  double centre = 1.0, radius = 1.0;
};
VarianceInflation variance_inflation(const Noise& noise, double radius, double blur);

}  // namespace pendular::segmentation
