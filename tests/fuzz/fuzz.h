#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/progress.h"
#include "base/temporary_folder.h"

namespace pendular::fuzz {

/// The folder of this process's trials; in memory where TMPDIR is.
inline const fs::path& folder() {
  static const TemporaryFolder made;
  return made.path();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Replaces the content of a file of this folder. The file stays open: no reader removes it.
inline fs::path put(const char* name, std::string_view bytes) {
  static std::map<std::string, int> files;
  const fs::path path = folder() / name;
  const auto [file, first] = files.try_emplace(name, -1);
  if (first) file->second = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const bool written = ::ftruncate(file->second, 0) == 0 && ::pwrite(file->second, bytes.data(), bytes.size(),
                                                                     0) == static_cast<ssize_t>(bytes.size());
  if (!written) std::abort();
  return path;
}

/// Calls a reader, which may take what it finds or throw pendular::Error; any other exception, and what the
/// sanitizers see, is a finding.
template <typename Read>
int read_quietly(const Read& read) {
  set_quiet(true);
  try {
    read();
  } catch (const Error&) {
  }
  return 0;
}

/// Gives the bytes to a reader as a file of this name.
template <typename Read>
int read_bytes(const std::uint8_t* data, std::size_t size, const char* name, const Read& read) {
  const fs::path path = put(name, text_of(data, size));
  return read_quietly([&] { read(path); });
}

/// Cuts the bytes at each record separator (0x1e) into files of these names, the last of which gets the rest;
/// those for which nothing is left are empty. Calls a reader with the first.
template <typename Read>
int read_parts(const std::uint8_t* data, std::size_t size, std::initializer_list<const char*> names,
               const Read& read) {
  std::string_view rest = text_of(data, size);
  for (const char* name : names) {
    const bool last = name == *(names.end() - 1);
    const std::string_view part = last ? rest : rest.substr(0, rest.find('\x1e'));
    put(name, part);
    rest.remove_prefix(part.size() < rest.size() ? part.size() + 1 : part.size());
  }
  return read_quietly([&] { read(folder() / *names.begin()); });
}

}  // namespace pendular::fuzz
