#pragma once

#include "volume/volume.h"

namespace pendular {

// The pixels of a volume that is being read. Internal to segmentation.

/// No pixels yet, of the type that the option's word says. BadUsage for any other.
Volume::Pixels pixels_of(const std::string& type);

std::size_t bytes_per_voxel(const Volume& volume);
char* bytes(Volume& volume);

/// Makes room for the pixels. A header may claim any size: what compression cannot have shrunk to
/// `data_bytes` is not there (BadInput), and more than the machine's memory is not tried (ComputationFailed).
void allocate(Volume& volume, const fs::path& path, std::uintmax_t data_bytes);

}  // namespace pendular
