#pragma once

#include <string>
#include <vector>

#include "segmentation/search/grey_levels.h"

namespace pendular::segmentation {

/// What is suspect about a volume, a line each: grey values that look cut off at either end (`histogram`, of
/// all voxels that count), and slices that hold one value, repeat the one before, or do not follow from it.
/// `first_slice`: the number of the volume's first one.
std::vector<std::string> image_defects(const Volume& volume, const Histogram& histogram,
                                       std::size_t first_slice);

}  // namespace pendular::segmentation
