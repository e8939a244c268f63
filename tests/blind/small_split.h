#pragma once

#include <map>
#include <string>

#include "blind/split.h"
#include "places.h"
#include "program.h"

namespace pendular::blind::test {

/// Three cases on one packing of some eighty beads: an effect, none, and one outside the library.
inline Split small_split() {
  return read_split(fs::path(pendular::test::source_folder()) / "samples/blind/small.toml", std::nullopt);
}

/// Name and content of every file below a folder.
inline std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = pendular::test::content(entry.path());
  return files;
}

}  // namespace pendular::blind::test
