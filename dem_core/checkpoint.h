#pragma once

#include <optional>
#include <string>

#include "base/files.h"
#include "dem_core/run_state.h"

namespace pendular {

/// Writes everything a run needs to go on bitwise as if never stopped. `identity` names the work (inputs,
/// seed).
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

}  // namespace pendular
