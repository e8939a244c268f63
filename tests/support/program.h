#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "places.h"

namespace pendular::test {

/// What a run of the program came to.
struct Outcome {
  int status = -1;
  std::string errors;  ///< standard error
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Runs a shell command in `folder`, in which $P is the program.
inline Outcome shell(const std::filesystem::path& folder, const std::string& command) {
  const auto errors = folder / "stderr.txt";
  const std::string line = "cd '" + folder.string() + "' && P='" + program() + "' && (" + command +
                           ") >/dev/null 2>'" + errors.string() + "'";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content(errors)};
}

}  // namespace pendular::test
