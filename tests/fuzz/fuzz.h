#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>

#include "base/error.h"
#include "base/progress.h"
#include "base/temporary_folder.h"

namespace pendular::fuzz {

/// The folder of this process's trials.
inline const fs::path& folder() {
  static const TemporaryFolder made;
  return made.path();
}

/// Gives the bytes to a reader as a file of this name. A reader may take them or throw pendular::Error; any
/// other exception, and what the sanitizers see, is a finding.
template <typename Read>
int read_bytes(const std::uint8_t* data, std::size_t size, const char* name, const Read& read) {
  set_quiet(true);
  const fs::path path = folder() / name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    read(path);
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace pendular::fuzz
