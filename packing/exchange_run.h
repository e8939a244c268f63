#pragma once

#include <vector>

#include "base/files.h"

namespace pendular {

// The frames of a run folder (frames/frame_*.vtp) as files of other programs.

/// In the order of their numbers. BadInput where the folder has none.
std::vector<fs::path> run_frames(const fs::path& run);

/// A ParaView collection: every frame by its name as seen from `path`, its strain as time. ParaView plays the
/// run when this one file is opened.
void write_pvd(const fs::path& path, const fs::path& run);

/// Where write_dump() puts the pairs: "run.dump" has "run.bonds.dump" beside it.
fs::path bonds_beside(const fs::path& dump);

/// A LAMMPS text dump of the beads (units si; id, type, radius, x, y, z and every array of the frames), and
/// one of the pairs beside it in the form of `dump local` (batom1, batom2, btype: 1 bond, 2 broken, 3
/// contact; and every array of the pairs). The time step is the frame's number, the time its strain. OVITO
/// opens both.
void write_dump(const fs::path& path, const fs::path& run);

}  // namespace pendular
