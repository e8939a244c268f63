#pragma once

#include <vector>

#include "packing/packing.h"

namespace pendular {

/// beads.csv: bead_id,x_um,y_um,z_um,diameter_um,sigma_centre_um,sigma_diameter_um,quality,boundary (0 or 1),
/// after the provenance as comments. Lengths to 1e-6 µm.
void write_beads(const fs::path& path, const std::vector<Bead>& beads, const Provenance& provenance);

/// Columns after diameter_um may be missing or a cell empty: sigmas 0, quality 1, no boundary. BadInput with
/// file and line as check_beads() and for negative sigmas.
std::vector<Bead> read_beads(const fs::path& path);

/// bridges.csv:
/// bead_i,bead_j,gap_um,sigma_gap_um,probability,bridge_diameter_um,sigma_bridge_diameter_um,state, beads by
/// their ids.
void write_bridges(const fs::path& path, const std::vector<Bead>& beads, const std::vector<Bridge>& bridges,
                   const Provenance& provenance);

/// Sorted by (i, j), i < j. Columns after bead_j may be missing or a cell empty: gap from the beads,
/// probability 1, state bridge, others 0. BadInput with file and line for a bead that is not in `beads`, one
/// joined to itself, and a pair found twice.
std::vector<Bridge> read_bridges(const fs::path& path, const std::vector<Bead>& beads);

}  // namespace pendular
