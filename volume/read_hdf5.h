#pragma once

#include <optional>

#include "volume/volume.h"

namespace pendular {

/// The HDF5 file that a path names, by itself or with an object in it ("scan.h5:/entry/data"); nothing for
/// any other path. Includes files that are not there, so that what is said of them is about HDF5.
std::optional<fs::path> hdf5_file(const fs::path& path);

/// A dataset of three dimensions (z, y, x; leading ones of length 1 are left out) of an HDF5 or NeXus file:
/// unsigned 8, 16 or 32 bit or float stay what they are; signed 8 and 16 bit and double become float. It is
/// read slab by slab of whole chunks; one that is neither chunked nor converted stays in its file. Voxel size
/// from `element_size_um` or NXtomoproc's coordinates, else as read_volume(). BadInput for a file that is no
/// HDF5, a dataset that is missing, of other dimensions or type, with chunks missing or damaged, compressed
/// by a filter that is not installed, or held by other files.
Volume read_hdf5(const fs::path& path, const ReadOptions& options);

}  // namespace pendular
