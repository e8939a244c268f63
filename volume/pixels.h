#pragma once

#include "volume/volume.h"

namespace pendular {

// The pixels of a volume that is being read. Internal to segmentation.

/// Types of numbers in files. Those that a volume has are kept; the others become float.
enum class Stored { uint8, uint16, uint32, float32, int8, int16, int32, int64, uint64, float64 };

/// Of an error's line on any other type.
inline constexpr const char* kStoredTypes = "a whole number of up to 64 bit, float or double";

/// By the names that NRRD and, after MET_ in capitals, MetaImage give it: "unsigned short", "ushort",
/// "uint16_t".
std::optional<Stored> stored_named(const std::string& name);
bool is_kept(Stored type);
std::size_t width_of(Stored type);  ///< bytes

/// No pixels yet, of the type that those stored become.
Volume::Pixels pixels_of(Stored type);

/// Numbers as they lie in a file become pixels, from the `first` on.
void convert(std::span<const std::byte> numbers, Stored type, bool big_endian, Volume& volume,
             std::size_t first);

std::size_t bytes_per_voxel(const Volume& volume);
char* bytes(Volume& volume);

/// Makes room for the pixels. A header may claim any size: what compression cannot have shrunk to
/// `data_bytes` is not there (BadInput), and more than the machine's memory is not tried (ComputationFailed).
void allocate(Volume& volume, const fs::path& path, std::uintmax_t data_bytes);

}  // namespace pendular
