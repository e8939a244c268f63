#pragma once

#include <optional>
#include <string>

#include "base/files.h"
#include "base/sample.h"
#include "dem_core/run_state.h"
#include "packing/packing.h"

namespace pendular::dem_core {

/// Names the work of a run: the hash of what is compressed and how, and of the model's version. `further` is
/// what changes it beside these, as the seed of what effects draw. Paths, commands and the program's version
/// do not count.
std::string work_identity(const Packing& packing, const Sample& sample, const std::string& further);

/// Writes everything a run needs to go on bitwise as if never stopped. `identity` names the work.
void write_checkpoint(const fs::path& path, const RunState& state, const std::string& identity);

/// BadInput where the file is damaged (its checksum tells), of another format version, or of other work.
RunState read_checkpoint(const fs::path& path, const std::string& identity);

/// Makes this the newest checkpoint of a run folder, `checkpoint`, and keeps the one before as
/// `checkpoint.previous`. Stopped at any moment, at least one of them is whole. Where it cannot be written,
/// throws ComputationFailed and both stay as they were.
void keep_checkpoint(const fs::path& folder, const RunState& state, const std::string& identity);

/// The newest of a folder's checkpoints that is good, with a warning where that is the one before; nothing
/// where there is none. BadInput where there are some and none is good.
std::optional<RunState> kept_checkpoint(const fs::path& folder, const std::string& identity);

void remove_checkpoints(const fs::path& folder);

}  // namespace pendular::dem_core
