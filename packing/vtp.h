#pragma once

#include "packing/packing.h"
#include "packing/polydata.h"

namespace pendular {

/// packing.vtp: points are beads, lines are bridges, lengths in µm; field data holds units, format version,
/// specimen_*_um and the provenance as JSON. The line array `state` holds 0 candidate, 1 bridge, 2 none,
/// 3 undetermined. What is read equals what was written to 1e-15 of each length (the change of unit), and
/// exactly in everything else.
PolyTable to_polydata(const Packing& packing);
void write_packing(const fs::path& path, const Packing& packing);

/// BadInput for what is no packing, was written by a later format version, or fails check_beads(); bridges
/// come sorted, and one found twice or with both ends on one bead is BadInput too.
Packing read_packing(const fs::path& path);

}  // namespace pendular
