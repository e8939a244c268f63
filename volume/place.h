#pragma once

// Where the voxels of a file lie. Internal to volume.

#include "volume/volume.h"
#include "volume/voxel_header.h"

namespace pendular {

/// Voxel size and origin from a header (null: none that is meant) and options. Where the header's voxels are
/// not cubic and the options do not overrule it, the size is that of the shortest edge. Returns the edges
/// over it. BadInput for a size from beyond 1 nm to 1 cm, and for an origin farther than a metre.
std::array<double, 3> place(Volume& volume, const Placement* header, const fs::path& path,
                            const ReadOptions& options);

/// BadInput where the voxel size or the origin cannot be meant.
void check_place(const Volume& volume, const fs::path& path);

/// Edges over the shortest; ones where they agree to a thousandth. BadInput beyond a factor of eight.
std::array<double, 3> over_shortest(const std::array<double, 3>& edges, const fs::path& path);

/// The volume on cubic voxels, with a warning where it was not.
Volume made_cubic(Volume volume, const std::array<double, 3>& edges, const fs::path& path);

}  // namespace pendular
