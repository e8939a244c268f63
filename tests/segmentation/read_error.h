#pragma once

#include <string>

#include "base/error.h"
#include "volume/volume.h"

namespace pendular::test {

/// What is wrong with a volume; empty where it can be read.
inline std::string error_of(const fs::path& path, const ReadOptions& options = {}) {
  try {
    read_volume(path, options);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace pendular::test
