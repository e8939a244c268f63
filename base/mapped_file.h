#pragma once

#include <cstddef>

#include "base/files.h"

namespace pendular {

/// A file's bytes as memory that the system fills as they are touched and takes back when it runs short. If
/// they cannot be read then, because the file was cut short or its disc fails, there is a SIGBUS: the program
/// ends with status 4 and one line (own_process).
class MappedFile {
 public:
  /// BadInput if the file cannot be read.
  explicit MappedFile(const fs::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }

  /// Gives back the memory; bytes touched later are read again.
  void release() const;

 private:
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace pendular
