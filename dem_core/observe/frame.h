#pragma once

#include <cstdint>
#include <vector>

#include "base/files.h"
#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// frames/frame_NNNN.vtp: beads with their displacement; standing bonds, broken bonds and touching pairs
/// without a bond, as lines; and what the observers that are switched on add (frame_observers.h). `stress`
/// in Pa.
void write_frame(const fs::path& path, const Simulation& simulation,
                 const std::vector<std::int64_t>& bead_ids, double stress, const Sample::Observe& observe);

}  // namespace pendular::dem_core
