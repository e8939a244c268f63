#pragma once

#include "base/sample.h"

namespace pendular::dem_core {

/// About how many steps a compression of this sample to its max_strain takes, holds counted and unloading
/// not: the lightest bead is taken to be three standard deviations below the mean, and the stiffest spring to
/// be the mean contact's.
double expected_steps(const Sample& sample);

}  // namespace pendular::dem_core
