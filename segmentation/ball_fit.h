#pragma once

#include <optional>
#include <span>
#include <vector>

#include "segmentation/container.h"
#include "segmentation/volume.h"

namespace pendular {

/// A ball in voxels of the volume and grey values.
struct GreyBall {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  double contrast = 0.0;    ///< grey value inside minus outside; negative for dark beads
  double background = 0.0;  ///< grey value outside
  Vec3 contrast_slope = Vec3::Zero(),
       background_slope = Vec3::Zero();  ///< grey values per voxel at the centre
};

/// What the fit of one ball gave. Standard errors hold for noise that is independent from voxel to voxel.
struct BallFit {
  GreyBall ball;
  double blur = 0.0;  ///< standard deviation of the point spread, voxels
  double sigma_centre = 0.0,
         sigma_radius = 0.0;  ///< standard errors (of the centre: root mean square over the axes), voxels
  double residual = 0.0;      ///< root mean square over the voxels used, grey values
  double free_share = 0.0;    ///< share of the shell that is neither hidden nor outside the volume
  double borne_out = 1.0;     ///< share of that which was not dropped as foreign
  bool converged = false;
};

/// How one round of fits looks at the shell around each ball.
struct FitSetting {
  double blur = 1.0;  ///< voxels; starting value if `fit_blur`
  bool fit_blur = false;
  double half_width = 3.0;  ///< of the shell, voxels
  double cone = 0.0;  ///< radius, on the ball's surface, of what is left out towards each neighbour, voxels
  double cone_gap =
      0.0;  ///< neighbours nearer than this (surface to surface, voxels) have a cone: there may be polymer
  bool drop_foreign = false;  ///< leave out directions that a blurred ball does not explain, too
  int iterations = 20;        ///< most
  std::size_t stride = 1;     ///< of the voxels used, every so many
  double tolerance = 1e-4;    ///< step of centre and radius below which the fit has converged, voxels
};

/// Fits ball `own` of `balls` to the grey values of its shell |r − R| < half_width by Levenberg–Marquardt:
/// centre, radius, contrast, background and, if asked, blur, from where `balls` has them; slopes stay. Left
/// out are the cones towards the other balls named by `neighbours`, voxels nearer than half_width to their
/// surfaces, and voxels as near to the container; with `drop_foreign` also the 96ths of the sphere in which
/// the mean residual, within the ball or around it, is more than 4.5 times what such means usually are: there
/// is something that nobody told of, as a wall, polymer, a pore, or a bead whose centre is not in the
/// picture.
BallFit fit_ball(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                 std::span<const int> neighbours, const std::optional<Container>& container,
                 const FitSetting& setting);

}  // namespace pendular
