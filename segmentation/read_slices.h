#pragma once

#include "segmentation/volume.h"

namespace pendular {

/// A folder of TIFF or PNG slices in the natural order of their names, z rising. BadInput for a hole, for
/// slices of several series, sizes or pixel types.
Volume read_slices(const fs::path& folder, const ReadOptions& options);

}  // namespace pendular
