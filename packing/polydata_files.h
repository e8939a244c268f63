#pragma once

#include "packing/polydata.h"

namespace pendular {

/// write_polydata() and read_polydata() by VTK. A shared object of its own holds them, loaded where a file is
/// first written or read: VTK's libraries take longer to load than all others of a program that draws
/// nothing.
struct PolydataFiles {
  void (*write)(const fs::path& path, const PolyTable& table);
  PolyTable (*read)(const fs::path& path);
};

}  // namespace pendular

extern "C" const pendular::PolydataFiles pendular_polydata_files;
