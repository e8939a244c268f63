#pragma once

#include <string>
#include <string_view>

#include "base/files.h"
#include "packing/polydata.h"

namespace pendular {

/// write_polydata() by VTK. A shared object of its own holds it, loaded where a file is first written: VTK's
/// libraries take longer to load than all others of a program that draws nothing.
struct PolydataFiles {
  void (*write)(const fs::path& path, const PolyTable& table);
};

inline constexpr const char* kPolydataSeal = "<!-- pendular sha256 ";

/// The comment that closes the files written here, so that damage is noticed.
inline std::string polydata_seal(std::string_view content) {
  return kPolydataSeal + sha256(content) + " -->\n";
}

}  // namespace pendular

extern "C" const pendular::PolydataFiles pendular_polydata_files;
