#pragma once

#include <optional>
#include <vector>

#include "packing/packing.h"

namespace pendular {

/// What spam's tables do not say, and which of their two scans is meant.
struct SpamTable {
  std::optional<double> voxel;  ///< m
  bool displaced = false;       ///< where ddic found the beads in the second scan
};

/// Beads of a table of spam: tab-separated, with columns Label or NodeNumber and Zpos, Ypos, Xpos in voxels,
/// as `spam-ddic` and `spam-ldic` write them. Diameters from a column radius (voxels), else `diameter` (m).
/// Rows of label 0 (no bead), and without a place, are left out; where `displaced`, Zdisp, Ydisp and Xdisp
/// are added and rows that did not converge (returnStatus other than 2) are left out as well. Both are said
/// in a warning. BadUsage without voxel size or diameter; BadInput with file and line.
std::vector<Bead> read_spam(const fs::path& path, const SpamTable& how, std::optional<double> diameter);

}  // namespace pendular
