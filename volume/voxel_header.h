#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "volume/pixels.h"
#include "volume/volume.h"

namespace pendular {

/// Where a header says that its voxels are, in its own unit of length.
struct Placement {
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< positive
  std::array<double, 3> origin{};
  double unit = 1e-6;  ///< m
};

/// What the header of a MetaImage or an NRRD says, checked: a volume of grey values, and where they lie. Each
/// file holds as many voxels as the others, x running fastest, slices in the order of the files.
struct VoxelHeader {
  enum class Encoding { raw, deflated, text };

  std::array<std::size_t, 3> size{};
  Stored type = Stored::uint8;
  Placement place;
  Encoding encoding = Encoding::raw;
  bool big_endian = false;
  std::vector<fs::path> files;
  std::uint64_t first_byte = 0;         ///< of the voxels in each file
  bool at_end = false;                  ///< the voxels are a file's last bytes, wherever they start
  std::optional<std::uint64_t> stored;  ///< bytes that deflated voxels take in their file

  std::uint64_t bytes_per_file() const;  ///< of voxels, once they are inflated
};

/// The header of a .mha or .mhd, and of a .nrrd or .nhdr. Nothing in it is handed on to other readers: file
/// names are expanded here (LIST, and patterns of one whole number such as slice%03d.raw 1 36 1), and must be
/// regular files. BadInput names file and field: fields missing or found twice, sizes whose product no file
/// holds, other types and encodings than those read here, a spacing that is not positive.
VoxelHeader read_meta_header(const fs::path& path);
VoxelHeader read_nrrd_header(const fs::path& path);

/// The voxels; `volume` has their size and the type they become. Plain ones of a single file stay there.
/// BadInput where a file does not hold exactly what the header says.
void read_voxels(const VoxelHeader& header, const fs::path& path, Volume& volume);

/// The volume that a header describes, on cubic voxels.
Volume read_with_header(const VoxelHeader& header, const fs::path& path, const ReadOptions& options);

/// The file of a header, and those that it names.
std::vector<fs::path> files_of(const fs::path& path, const VoxelHeader& header);

}  // namespace pendular
