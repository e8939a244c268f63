#pragma once

#include "segmentation/search/grey_levels.h"
#include "segmentation/search/grid.h"
#include "volume/volume.h"

namespace pendular::segmentation {

/// The box between outer planes that hold one grey value, that of the first voxel (planes before the box) or
/// of the last one (planes after it): what a volume was padded with along its axes, or where nothing was
/// written. The whole volume where that value is found in the middle of the box, too: it is the specimen's
/// own (air without noise).
Box without_padding(const Volume& volume);

/// That part of a volume, in the volume's frame. Whole slices of pixels that the volume does not own are not
/// copied.
Volume part_of(const Volume& volume, const Box& box);

/// Takes padding that is no plane (the corners of a turned volume) out of a histogram: the grey value of all
/// eight corners, where the volume's middle does not have it.
void leave_out_corners(Histogram& histogram, const Volume& volume);

}  // namespace pendular::segmentation
