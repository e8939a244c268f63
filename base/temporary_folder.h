#pragma once

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/files.h"

namespace pendular {

/// A folder of its own among the system's temporary ones, while it lives. ComputationFailed where there is no
/// room for it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "pendular.XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw ComputationFailed(fmt::format("{}: folder cannot be created: {}", name, std::strerror(errno)));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace pendular
