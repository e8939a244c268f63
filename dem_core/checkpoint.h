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

}  // namespace pendular
