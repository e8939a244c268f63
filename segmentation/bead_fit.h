#pragma once

#include <optional>
#include <vector>

#include "packing/neighbours.h"
#include "segmentation/ball_fit.h"
#include "segmentation/bead_search.h"
#include "segmentation/noise.h"

namespace pendular {

/// The balls that the grey values bear out, all fitted together with what surrounds each.
struct FittedBeads {
  std::vector<BallFit> fits;
  double blur = 0.0;  ///< standard deviation of the point spread, voxel included, voxels
  Noise noise;
  std::size_t rejected = 0;  ///< seeds that turned out to be no bead
  std::vector<Seed> grains;  ///< bodies of the mask that no ball covers: too irregular for the fit
};

std::vector<GreyBall> balls_of(const std::vector<BallFit>& fits);

/// Pairs of balls whose surfaces are nearer than `max_gap` voxels, sorted.
std::vector<IndexPair> near_balls(const std::vector<GreyBall>& balls, double max_gap);

/// Fits balls to the seeds in rounds, since each fit leaves out what its neighbours hide: first coarsely,
/// with the blur, then with the blur that most agree on. Seeds are rejected whose fit does not converge,
/// whose contrast is below 0.4 of the classes', whose centre lies outside the picture or the container, which
/// are smaller than least_radius or which mostly overlap a better fit. `cutoff`: gaps below cutoff × D may
/// hold polymer and are left out of fits.
FittedBeads fit_beads(const Volume& volume, const BeadSearch& search, double cutoff);

/// Share of at most 150 of the seeds that a first fit bears out as balls, each weighted by 1/(1 + (m/0.15)²)
/// with m its residual over its contrast: irregular pores can be fitted too, but badly.
double ball_share(const Volume& volume, const BeadSearch& search, double cutoff);

}  // namespace pendular
