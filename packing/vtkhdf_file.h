#pragma once

#include "packing/polydata.h"

namespace pendular {

/// What HDF5 does of write_vtkhdf(); false where the file cannot be written. Lives in the shared object of
/// polydata_files.h.
bool write_vtkhdf_file(const fs::path& path, const PolyTable& table);

}  // namespace pendular
