#pragma once

#include <opencv2/core.hpp>

#include "segmentation/segment.h"

namespace pendular::segmentation {

/// Mean diameters of beads over distance from the axis and height, less the one that all beads should have on
/// average, their median: blue smaller, red larger, full colour at four standard errors of a cell; each cell
/// with its difference in voxels and its number of beads. Without trend colours are pale and mixed; beam
/// hardening, a tilted detector or a wrong centre of rotation make bands.
cv::Mat radius_map(const Volume& volume, const Segmentation& segmentation);

}  // namespace pendular::segmentation
