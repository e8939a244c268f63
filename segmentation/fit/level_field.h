#pragma once

#include <vector>

#include "segmentation/fit/ball_fit.h"

namespace pendular::segmentation {

/// Gives each ball the slopes of contrast and background at its place, from quadratics in position through
/// those of all balls (least squares): beam hardening makes grey values fall towards the middle of a
/// specimen, and a level that changes across a ball moves the centre that is fitted. Nothing where there are
/// too few balls for it.
void set_level_slopes(std::vector<GreyBall>& balls);

}  // namespace pendular::segmentation
