#pragma once

#include "packing/polydata.h"

namespace pendular {

/// What VTK does of write_polydata() and HDF5 of write_vtkhdf(): the file of a table, the former without its
/// seal; false where it cannot be written. A shared object of its own holds it, loaded where a file is first
/// written: VTK's libraries take longer to load than all others of a program that draws nothing.
struct PolydataFiles {
  bool (*write)(const fs::path& path, const PolyTable& table);
  bool (*write_vtkhdf)(const fs::path& path, const PolyTable& table);
};

}  // namespace pendular

extern "C" const pendular::PolydataFiles pendular_polydata_files;
