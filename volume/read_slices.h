#pragma once

#include "volume/volume.h"

namespace pendular {

/// A folder of TIFF or PNG slices in the natural order of their names, z rising. BadInput for a hole, for
/// slices of several series, sizes or pixel types.
Volume read_slices(const fs::path& folder, const ReadOptions& options);

/// The TIFF and PNG files of a folder.
std::vector<fs::path> slice_files(const fs::path& folder);

}  // namespace pendular
