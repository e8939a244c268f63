#pragma once

#include <span>
#include <vector>

#include "segmentation/bridges/neck_statistics.h"

namespace pendular::segmentation {

/// What became of necks of one size that were put into the picture.
struct NeckRecovery {
  double radius = 0.0;  ///< put in, voxels
  std::size_t injected = 0;
  double found = 0.0;      ///< share that is said to be a bridge
  double mean = 0.0;       ///< radius measured of those found, voxels
  double rms_error = 0.0;  ///< of it, voxels
};

/// Puts necks of several sizes, with the population's contrast, into the grey values between pairs that have
/// none (`hosts`, each once; `near` are the balls that may hide each) and measures them as any other: what a
/// volume's own noise, blur and artefacts let through. A neck is found where its probability is at least
/// `threshold`. Sizes are shares of the pair's radius; one point for each.
std::vector<NeckRecovery> recover_injected(const Volume& volume, std::span<const GreyBall> balls,
                                           std::span<const BallPair> hosts,
                                           std::span<const std::vector<int>> near,
                                           const std::optional<Container>& container,
                                           const ImageKnowledge& knowledge, const NeckPopulation& population,
                                           double threshold);

}  // namespace pendular::segmentation
