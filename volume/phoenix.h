#pragma once

#include <array>
#include <string>

#include "base/files.h"

namespace pendular {

/// What the parameter file (.pcr) of a GE phoenix reconstruction says of its headerless volume (.vol).
struct PhoenixVolume {
  fs::path data;
  std::array<std::size_t, 3> size{};  ///< voxels along x, y, z
  std::string type;                   ///< "uint16" or "float", little endian
  double spacing = 0.0;               ///< edge of a voxel, m
};

/// By the keys of its section [VolumeData]: Volume_SizeX, Volume_SizeY, Volume_SizeZ, Format (5: unsigned 16
/// bit, 10: float), VoxelSizeRec (mm). The volume lies beside it: under the name of the key VOL_File, whose
/// folder is that of another machine, or its own with .vol. BadInput naming the key for what is missing or
/// not understood.
PhoenixVolume read_pcr(const fs::path& path);

}  // namespace pendular
