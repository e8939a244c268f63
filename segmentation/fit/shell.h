#pragma once

#include <optional>
#include <span>

#include "segmentation/fit/ball_fit.h"
#include "segmentation/fit/shell_voxels.h"

namespace pendular::segmentation {

/// What is seen about the surface of a ball.
struct Shell {
  ShellVoxels voxels;
  double free_share = 0.0;  ///< of the shell, neither hidden nor outside the volume
};

/// The shell of ball `own` as fit_ball() describes it, less the grey values that are known.
Shell shell_about(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                  std::span<const Neighbour> neighbours, const std::optional<Container>& container,
                  const FitSetting& setting, const GreyAt& known);

}  // namespace pendular::segmentation
