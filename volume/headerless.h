#pragma once

#include "volume/volume.h"

namespace pendular {

/// A file of voxels alone, little endian, x running fastest; size, type and spacing are the options'.
/// BadUsage without a spacing, BadInput where the file does not hold exactly the voxels.
Volume read_headerless(const fs::path& path, const ReadOptions& options);

}  // namespace pendular
