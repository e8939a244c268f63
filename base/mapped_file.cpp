#include "base/mapped_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <mutex>

#include "base/error.h"

namespace pendular {
namespace {

/// Nothing but this may be done where a byte of a mapped file is not there.
void end_with_one_line(int) {
  constexpr char line[] = "pendular: an input file was cut short or could not be read while it was in use\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line, sizeof(line) - 1);
  ::_exit(4);
}

void expect_missing_bytes() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};
    action.sa_handler = end_with_one_line;
    ::sigaction(SIGBUS, &action, nullptr);
  });
}

}  // namespace

MappedFile::MappedFile(const fs::path& path) : size_(fs::file_size(path)) {
  if (size_ == 0) return;
  expect_missing_bytes();
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  void* bytes = file < 0 ? MAP_FAILED : ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file, 0);
  if (file >= 0) ::close(file);
  if (bytes == MAP_FAILED)
    bad_input("{}: found a file that cannot be read, expected a readable one", path.string());
  data_ = static_cast<const std::byte*>(bytes);
}

MappedFile::~MappedFile() {
  if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

void MappedFile::release() const {
  if (data_) ::madvise(const_cast<std::byte*>(data_), size_, MADV_DONTNEED);
}

}  // namespace pendular
