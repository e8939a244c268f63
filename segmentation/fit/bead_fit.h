#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "packing/neighbours.h"
#include "segmentation/fit/ball_fit.h"
#include "segmentation/fit/noise.h"
#include "segmentation/fit/rings.h"
#include "segmentation/search/bead_search.h"

namespace pendular::segmentation {

/// The balls that the grey values bear out, all fitted together with what surrounds each.
struct FittedBeads {
  std::vector<BallFit> fits;
  double blur = 0.0;  ///< standard deviation of the point spread, voxel included, voxels
  Noise noise;
  std::shared_ptr<const Rings> rings;  ///< taken away in the last fits; none where none show
  std::size_t rejected = 0;            ///< seeds that turned out to be no bead
  std::vector<Seed> grains;            ///< bodies of the mask that no ball covers: too irregular for the fit
};

std::vector<GreyBall> balls_of(const std::vector<BallFit>& fits);

/// Of each ball, what shows in its shell.
using Neighbours = std::vector<std::vector<Neighbour>>;

/// The setting of a last round: all voxels within three blurs of the surface, the blur being known.
FitSetting fine_setting(const std::vector<BallFit>& fits, double blur);

/// Every ball fitted with the others where they are; `known`: of each ball, if it is given, what is known of
/// all else (ball_fit.h). `name` is said while it lasts.
std::vector<BallFit> fit_all(const Volume& volume, const std::vector<GreyBall>& balls,
                             const Neighbours& neighbours, const std::optional<Container>& container,
                             const FitSetting& setting, const std::string& name,
                             const std::function<KnownGrey(std::size_t)>& known = {});

double median_radius(const std::vector<BallFit>& fits);

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

}  // namespace pendular::segmentation
