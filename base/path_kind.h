#pragma once

#include <filesystem>

#include "base/error.h"

namespace pendular {

/// What stands at a path, links followed. BadInput where that cannot be seen, which std::filesystem throws in
/// words of its own: links that lead in circles, a name that is too long, a folder that may not be entered.
inline std::filesystem::file_type kind_at(const std::filesystem::path& path) {
  std::error_code why;
  const auto kind = std::filesystem::status(path, why).type();
  if (kind == std::filesystem::file_type::none)
    bad_input("{}: cannot be seen: {}", path.string(), why.message());
  return kind;
}

inline bool is_there(const std::filesystem::path& path) {
  return kind_at(path) != std::filesystem::file_type::not_found;
}

inline bool is_folder(const std::filesystem::path& path) {
  return kind_at(path) == std::filesystem::file_type::directory;
}

inline bool is_file(const std::filesystem::path& path) {
  return kind_at(path) == std::filesystem::file_type::regular;
}

}  // namespace pendular
