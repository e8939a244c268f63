#pragma once

// What a scanner of Gaussian point spread sees of a body, voxel by voxel. Internal to segmentation.

#include <span>
#include <vector>

#include "base/vec3.h"

namespace pendular::phantom {

/// A solid ball; lengths in voxels, voxel (i, j, k) being the unit cube centred on (i, j, k).
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

/// The body of a bridge: the cylinder of `radius` along the line of centres of two balls, less both balls.
/// Its height at distance r from the axis is h(r) = δ0 + (R_a − √(R_a² − r²)) + (R_b − √(R_b² − r²)).
struct Neck {
  Ball a, b;
  double radius = 0.0;  ///< below that of either ball
};

/// Slice `z` of an image nx voxels wide, x running fastest.
struct Slice {
  std::span<float> voxels;
  int nx = 0, ny = 0, z = 0;
};

/// How sharp the image is. A voxel is the mean over cells³ points in it of the body convolved with a
/// Gaussian of sd `sd`, whose variance is that of the point spread plus that of the average over a cell,
/// 1/(12 cells²). One cell from a point spread of 0.8 voxel on, where the Gaussian stands for the cube's
/// average within 5e-4 of an edge; two per axis below.
struct Sharpness {
  explicit Sharpness(double point_spread_sd);
  double reach() const;  ///< farther than this from a voxel's centre nothing shows in it

  double sd;
  std::vector<double> offsets;  ///< of the cells from the voxel's centre, the same along every axis
};

/// Adds the ball's share of every voxel of the slice, by the closed form of a blurred ball at distance r,
///   Φ((R−r)/s) + Φ((R+r)/s) − 1 − s/r (φ((R−r)/s) − φ((R+r)/s)).
void add_ball(const Ball& ball, const Sharpness& sharpness, const Slice& slice);

/// A neck as the scanner sees it: tabulated over distance from and position along its axis, about which it is
/// symmetric, in steps of an eighth of the sharpness.
class NeckImage {
 public:
  NeckImage(const Neck& neck, const Sharpness& sharpness);

  /// Adds the neck's share of every voxel of the slice.
  void add_to(const Slice& slice) const;
  bool touches(int z) const;

  /// The neck's share at a point: its place along the axis from the centre of ball a, its distance from it.
  double at(double along, double across) const;

 private:
  const Sharpness* sharpness_;
  Vec3 centre_, axis_, middle_, half_;  ///< of ball a; unit vector to b; middle and half-widths of its box
  double step_, start_;                 ///< of the table, and the position along the axis where it begins
  std::size_t rows_ = 0, columns_ = 0;  ///< along and across
  std::vector<float> table_;
};

/// The share of voxel (x, y) in a disc about the origin of the plane, for radii far above the sharpness.
double disc_share(double x, double y, double radius, const Sharpness& sharpness);

/// The share of a voxel `depth` inside the face of a half-space, the face square to an axis.
double half_space_share(double depth, const Sharpness& sharpness);

}  // namespace pendular::phantom
