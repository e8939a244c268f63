#pragma once

#include <vector>

#include "volume/volume.h"

namespace pendular {

/// Whether a folder is a Zarr array or an OME-Zarr image.
bool is_zarr(const fs::path& folder);

/// The folder of an OME-Zarr image (its largest dataset) or of a Zarr array, format 2, axes z, y, x after
/// leading ones of length 1; chunks plain, or compressed by blosc, zlib or gzip. Unsigned 8, 16 or 32 bit and
/// float stay what they are; signed 8 and 16 bit and double become float. Voxel size by the scale of the axes
/// that have a unit. Chunks are read one by one into the volume. BadInput, naming the file, for damaged
/// metadata, and for a chunk that is missing or damaged: a fill value is not taken for a measured one.
Volume read_zarr(const fs::path& folder, const ReadOptions& options);

/// Metadata and chunks that it would read.
std::vector<fs::path> zarr_files(const fs::path& folder);

}  // namespace pendular
