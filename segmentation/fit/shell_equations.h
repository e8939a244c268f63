#pragma once

#include <Eigen/Core>

#include <vector>

#include "segmentation/fit/ball_fit.h"
#include "segmentation/fit/shell_voxels.h"

namespace pendular::segmentation {

/// Of a fitted ball: centre (relative to the shell's), radius, contrast, background, blur.
using BallParameters = Eigen::Matrix<double, 7, 1>;
using NormalMatrix = Eigen::Matrix<double, 7, 7>;

/// Sums of the normal equations of the least-squares problem of a shell.
struct Equations {
  NormalMatrix matrix = NormalMatrix::Zero();
  BallParameters right = BallParameters::Zero();
  double squares = 0.0;  ///< of what is left of the grey values
};

/// At the parameters `q`, with the slopes of contrast and background of `ball`.
Equations equations(const ShellVoxels& voxels, const GreyBall& ball, const BallParameters& q, bool fit_blur);

/// What is left of each voxel's grey value.
VoxelNumbers rests(const ShellVoxels& voxels, const GreyBall& ball, const BallParameters& q);

/// For each column of weights the sum over the voxels of weight times slopes with respect to the parameters.
std::vector<BallParameters> weighted_slopes(const ShellVoxels& voxels, const GreyBall& ball,
                                            const BallParameters& q,
                                            const std::vector<VoxelNumbers>& weights);

}  // namespace pendular::segmentation
