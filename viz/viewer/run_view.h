#pragma once

#include "run_folder/run_folder.h"
#include "viz/viewer/specimen_view.h"

namespace pendular::viz {

/// The frames of a run as a view, every array of their beads and pairs a field, and the number of broken
/// bonds of each bead: as many frames, evenly taken from first to last, as `most_bytes` of a page hold, and
/// at least one. BadInput where a frame is broken or differs from the others in its beads or arrays.
SpecimenView run_view(const RunFolder& run, std::size_t most_bytes = 9 << 20);

}  // namespace pendular::viz
