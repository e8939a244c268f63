#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "volume/voxel_header.h"

namespace pendular {

/// What the metadata of a Zarr array (format 2) of three dimensions say, checked. Internal to volume.
struct ZarrArray {
  enum class Codec { none, deflate, blosc };

  fs::path folder;                             ///< with .zarray and the chunks
  std::vector<fs::path> metadata;              ///< files that were read for this
  std::array<std::size_t, 3> size{}, chunk{};  ///< along x, y, z
  std::size_t leading = 0;                     ///< axes of length 1 before z
  std::size_t chunk_leading = 1;               ///< their chunks' lengths, multiplied
  Stored type = Stored::uint8;
  bool big_endian = false;
  Codec codec = Codec::none;
  char separator = '.';
  std::optional<Placement> place;

  std::size_t chunk_bytes() const { return chunk_leading * chunk[0] * chunk[1] * chunk[2] * width_of(type); }
  fs::path chunk_file(const std::array<std::size_t, 3>& at) const;  ///< by its number along x, y, z
};

/// The array in a folder, or the largest one of an OME-Zarr image. BadInput, opening with the file, for
/// metadata that are damaged, of Zarr format 3, or ask for what is not read here.
ZarrArray read_zarr_metadata(const fs::path& folder);

}  // namespace pendular
