#pragma once

#include "volume/volume.h"

namespace pendular {

/// The same picture on cubic voxels of the volume's spacing. The volume's voxels are `edges` of these long
/// (at least one, along x, y, z); voxel (0, 0, 0) stays where it is. Between voxels by the cubics of Catmull
/// & Rom (1974), which leave a grey value that is linear in place as it is; whole grey values are rounded.
Volume resampled(const Volume& volume, const std::array<double, 3>& edges);

}  // namespace pendular
