#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular::viz {

/// Runs a program found on PATH in a folder, without a shell, with no input and no output but for standard
/// error, which goes to the file `errors` where one is named. Its exit status, 127 where it is not found;
/// nothing where it cannot be started or was killed. Ends it where the user stops the program.
std::optional<int> run_program(std::vector<std::string> words, const fs::path& folder,
                               const fs::path& errors = {});

}  // namespace pendular::viz
