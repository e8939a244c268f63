#pragma once

// What the grey values between two beads say of a neck there. Internal to segmentation.

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "phantom/phantom_raster.h"
#include "segmentation/fit/ball_fit.h"

namespace pendular::segmentation {

/// Two balls that may have a neck between them, in voxels.
struct BallPair {
  int i = 0, j = 0;
  double gap = 0.0;
  double radius = 0.0;  ///< harmonic mean of both: what the crevice's shape follows near the axis
};

BallPair ball_pair(std::span<const GreyBall> balls, int i, int j);

/// The coordinates of the crevice between two balls.
class CreviceAxes {
 public:
  CreviceAxes(const GreyBall& a, const GreyBall& b);

  struct Place {
    double along = 0.0;    ///< the axis, from the centre of a
    double across2 = 0.0;  ///< square of the distance from the axis
  };
  Place place(const Vec3& p) const;

  struct Height {
    double from_middle = 0.0;  ///< distance from the surface halfway between the balls
    double half = 0.0;         ///< of what is between them there
  };
  /// For unequal balls the surface halfway is bent.
  Height height(const Place& place) const;

  double length() const { return length_; }
  const Vec3& axis() const { return axis_; }

 private:
  Vec3 centre_, axis_;
  double length_, square_a_, square_b_;
};

/// Radii of necks that are tried, over the pair's radius.
std::span<const double> neck_shares();

/// Blurred necks of every share in the crevice's own coordinates: cells of u, the distance from the surface
/// halfway between both balls, and of ρ, that from their axis. Cell (u, ρ) has the number u·wide + ρ.
struct NeckTemplate {
  static constexpr double kCell = 0.5;  ///< edge of a cell, voxels
  std::size_t high = 0, wide = 0;
  std::vector<std::vector<float>> necks;

  /// What a neck of this radius, over the pair's, fills of a voxel at a place; 0 outside the cells.
  double at(double share, double from_middle, double across) const;
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
  const Rings* rings = nullptr;          ///< to be subtracted
};

/// From the voxels outside both balls, within 0.6 radii and three blurs of their axis, at least three blurs
/// from the `others`, the container and the picture's edge. The balls' blurred images are subtracted; a
/// background, the balls' radii and the blur are free within their standard errors. Nothing where less than
/// half of the crevice is seen.
std::optional<NeckEvidence> neck_evidence(const Volume& volume, std::span<const GreyBall> balls,
                                          const BallPair& pair, std::span<const int> others,
                                          const std::optional<Container>& container,
                                          const ImageKnowledge& knowledge, const NeckTemplates& templates);

}  // namespace pendular::segmentation
