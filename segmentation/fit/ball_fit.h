#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "segmentation/search/container.h"
#include "volume/volume.h"

namespace pendular::segmentation {

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
         sigma_radius = 0.0;     ///< standard errors (of the centre: root mean square over the axes), voxels
  double residual = 0.0;         ///< root mean square over the voxels used, grey values
  double free_share = 0.0;       ///< share of the shell that is neither hidden nor outside the volume
  double explained_share = 1.0;  ///< share of that which was not dropped as foreign
  bool converged = false;
};

/// Another ball that shows in a ball's shell.
struct Neighbour {
  int ball = 0;          ///< its place among all
  bool polymer = false;  ///< there may be some in between: a cone towards it is left out
};

/// A grey value at a place in the volume.
using GreyAt = std::function<double(const Vec3&)>;

/// What is known of everything in a ball's shell but the ball.
struct KnownGrey {
  GreyAt grey;                 ///< without the ball's background; empty: nothing is known
  std::vector<GreyAt> errors;  ///< of it, each by one standard error; independent of each other
};

struct Rings;

/// How one round of fits looks at the shell around each ball.
struct FitSetting {
  double blur = 1.0;  ///< voxels; starting value if `fit_blur`
  bool fit_blur = false;
  double half_width = 3.0;  ///< of the shell, voxels
  double cone =
      0.0;  ///< radius, on the ball's surface, of what is left out where there may be polymer, voxels
  const Rings* rings = nullptr;  ///< to be subtracted
  bool drop_foreign = false;     ///< leave out directions that a blurred ball does not explain, too
  int iterations = 20;           ///< most
  std::size_t stride = 1;        ///< of the voxels used, every so many
  double tolerance = 1e-4;       ///< step of centre and radius below which the fit has converged, voxels
};

/// Fits ball `own` of `balls` to the grey values of its shell |r − R| < half_width by Levenberg–Marquardt:
/// centre, radius, contrast, background and, if asked, blur, from where `balls` has them; slopes stay. Left
/// out are the cones towards neighbours, voxels nearer than half_width to their surfaces or to the container,
/// and voxels whose rings are not known. Where the grey values of all neighbours and of the polymer are
/// `known`, they are subtracted, of the neighbours only their insides are left out, and errors of what is
/// known add to those of the ball. With `drop_foreign` also the 96ths of the sphere in which the mean
/// residual, within the ball or around it, is more than 4.5 times what such means usually are: there is
/// something that nobody told of, as a wall, polymer, a pore, or a bead whose centre is not in the picture.
BallFit fit_ball(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                 std::span<const Neighbour> neighbours, const std::optional<Container>& container,
                 const FitSetting& setting, const KnownGrey& known = {});

}  // namespace pendular::segmentation
