#pragma once

// What the grey values between two beads say of a neck there. Internal to segmentation.

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "segmentation/ball_fit.h"
#include "segmentation/phantom_raster.h"

namespace pendular {

/// Two balls that may have a neck between them, in voxels.
struct BallPair {
  int i = 0, j = 0;
  double gap = 0.0;
  double radius = 0.0;  ///< harmonic mean of both: what the crevice's shape follows near the axis
};

/// Radii of necks that are tried, over the pair's radius.
std::span<const double> neck_shares();

/// Blurred necks of every share in the crevice's own coordinates: cells of u, the distance from the surface
/// halfway between both balls, and of ρ, that from their axis. Cell (u, ρ) has the number u·wide + ρ.
struct NeckTemplate {
  static constexpr double kCell = 0.5;  ///< edge of a cell, voxels
  std::size_t high = 0, wide = 0;
  std::vector<std::vector<float>> necks;
};

/// Templates for pairs: alike for those whose gaps are within a fifth of a voxel and whose radii are within
/// three per cent.
class NeckTemplates {
 public:
  NeckTemplates(std::span<const BallPair> pairs, double blur);
  const NeckTemplate& of(const BallPair& pair) const;

 private:
  using Key = std::pair<long, long>;
  static Key key_of(const BallPair& pair);
  std::map<Key, NeckTemplate> templates_;
};

/// What the crevice between two balls tells of a neck, per share: the gain in log-likelihood over no neck is
/// A n − A² d/2, A being the polymer's grey value over the surroundings' as a share of the balls'.
struct NeckEvidence {
  std::vector<double> n, d;
};

/// What is known of all balls' images.
struct ImageKnowledge {
  double blur = 1.0, sigma_blur = 0.02;  ///< voxels
  double sigma_radius = 0.02;            ///< voxels
  double noise_variance = 1.0;           ///< of what a cell's mean is off by, times its voxels
};

/// From the voxels outside both balls, within 0.6 radii and three blurs of their axis, at least three blurs
/// from the `others`, the container and the picture's edge. The balls' blurred images are subtracted; a
/// background, the balls' radii and the blur are free within their standard errors. Nothing where less than
/// half of the crevice is seen.
std::optional<NeckEvidence> neck_evidence(const Volume& volume, std::span<const GreyBall> balls,
                                          const BallPair& pair, std::span<const int> others,
                                          const std::optional<Container>& container,
                                          const ImageKnowledge& knowledge, const NeckTemplates& templates);

}  // namespace pendular
