#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/files.h"
#include "base/mapped_file.h"
#include "base/provenance.h"
#include "base/vec3.h"

namespace pendular {

/// A grey value wherever it lies: those of a mapped file follow a header of any length.
template <typename T>
class Grey {
 public:
  using Value = T;
  operator T() const { return std::bit_cast<T>(bytes_); }

 private:
  std::array<std::byte, sizeof(T)> bytes_;
};

/// A three-dimensional image of cubic voxels in its native pixel type, x running fastest. Voxel (i, j, k) has
/// its centre at origin + spacing·(i, j, k).
struct Volume {
  using Pixels = std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>,
                              std::vector<std::uint32_t>>;

  std::array<std::size_t, 3> size{};  ///< voxels along x, y, z
  double spacing = 1e-6;              ///< edge of a voxel, m
  Vec3 origin = Vec3::Zero();         ///< centre of voxel (0, 0, 0), m
  Pixels pixels;  ///< size[0]·size[1]·size[2] of them; with a `file` or `memory`, none of that type
  std::shared_ptr<const MappedFile> file = nullptr;  ///< where set, the pixels are there, from first_byte on
  std::size_t first_byte = 0;
  std::shared_ptr<const void> memory = nullptr;  ///< where set, the pixels are there: another owner's

  std::size_t voxels() const { return size[0] * size[1] * size[2]; }
};

/// Calls f with the pixels as a std::span<const Grey<T>>, T being their native type.
template <typename Function>
decltype(auto) with_pixels(const Volume& volume, Function&& f) {
  return std::visit(
      [&]<typename T>(const std::vector<T>& own) -> decltype(auto) {
        const void* first = own.data();
        if (volume.memory) first = volume.memory.get();
        if (volume.file) first = volume.file->data() + volume.first_byte;
        return f(std::span(static_cast<const Grey<T>*>(first), volume.voxels()));
      },
      volume.pixels);
}

/// Gives back the memory that pixels of a file took; what is touched later is read again. For the end of a
/// pass over all of them.
void release(const Volume& volume);

/// "uint8", "uint16", "float" or "uint32".
std::string pixel_type(const Volume& volume);

/// What a file does not say of itself.
struct ReadOptions {
  std::optional<double> spacing;                       ///< m; overrides the file's
  std::optional<std::array<std::size_t, 3>> raw_size;  ///< of a headerless file
  std::string raw_type;  ///< of a headerless file, little endian: uint8, int16, float, ...
};

/// Reads a volume of any known format (volume/format.h): MetaImage, NRRD, multi-page TIFF, a folder of TIFF
/// or PNG slices in the natural order of their names (z rising), HDF5 and NeXus (by the dataset's name:
/// "scan.h5:/entry/data"), OME-Zarr, DICOM (lengths in mm), GE phoenix (mm), or,
/// with `raw_size`, a headerless file. Other lengths in a header count as µm, unless an NRRD names another
/// unit; spacing 1 or none means unknown: 1 µm, with a warning. Voxels that are not cubic are taken to cubic
/// ones of their shortest edge (volume/resample.h), with a warning. BadInput, in one line, for whatever does
/// not hold a grey volume: truncated data, a header that does not match it, a missing slice, slices of
/// several sizes, colours, other pixel types, NaN or infinity, or one grey value throughout. Uncompressed
/// MetaImage, headerless and phoenix data stay in their file, so the volume may be larger than memory.
Volume read_volume(const fs::path& path, const ReadOptions& options = {});

/// The file or folder that a volume's name means, without the dataset that it may name.
fs::path volume_place(const fs::path& path);
/// BadInput, opening with `where`, for a grey value that is no number, or one grey value throughout.
void check_pixels(const Volume& volume, const std::string& where);

/// The files that a volume is read from: the one that is named and those that it names, or a folder's slices.
std::vector<fs::path> volume_files(const fs::path& path);

/// Writes a MetaImage (.mha; lengths in µm, provenance in its header) or a TIFF of one page per slice (.tif,
/// .tiff; BigTIFF from 2 GiB on; no lengths), uncompressed, whole or not at all.
void write_volume(const fs::path& path, const Volume& volume, const Provenance& provenance = {});

}  // namespace pendular
