#include "volume/phoenix.h"

#include <INIReader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "base/path_kind.h"
#include "volume/format.h"
#include "volume/headerless.h"

namespace pendular {
namespace {

constexpr const char* kSection = "VolumeData";
constexpr double kMillimetre = 1e-3;

class Keys {
 public:
  explicit Keys(const fs::path& path) : path_(path), reader_(path.string()) {}

  std::string text(const std::string& key) const { return reader_.Get(kSection, key, ""); }

  double number(const std::string& key) const {
    std::string found = text(key);
    found.resize(std::min({found.size(), found.find('\n'), std::size_t{40}}));  // lines may go on in the next
    char* end = nullptr;
    const double value = std::strtod(found.c_str(), &end);
    if (found.empty() || *end != '\0' || !std::isfinite(value) || value <= 0.0)
      bad_input("{}: [{}] {}: found \"{}\", expected a positive number", path_.string(), kSection, key,
                found);
    return value;
  }

  std::size_t count(const std::string& key) const {
    const double value = number(key);
    if (value != std::floor(value) || value > 1e6)
      bad_input("{}: [{}] {}: found {}, expected a number of voxels", path_.string(), kSection, key, value);
    return static_cast<std::size_t>(value);
  }

 private:
  const fs::path& path_;
  INIReader reader_;
};

fs::path data_of(const fs::path& path, std::string named) {
  std::replace(named.begin(), named.end(), '\\', '/');
  for (const fs::path& candidate :
       {path.parent_path() / fs::path(named).filename(), fs::path(path).replace_extension(".vol")})
    if (is_file(candidate)) return candidate;
  bad_input("{}: found no volume beside it, expected {}", path.string(),
            fs::path(path).replace_extension(".vol").filename().string());
}

}  // namespace

PhoenixVolume read_pcr(const fs::path& path) {
  const Keys keys(path);
  PhoenixVolume volume;
  volume.size = {keys.count("Volume_SizeX"), keys.count("Volume_SizeY"), keys.count("Volume_SizeZ")};
  const double format = keys.number("Format");
  if (format != 5.0 && format != 10.0)
    bad_input("{}: [{}] Format: found {}, expected 5 (unsigned 16 bit) or 10 (float)", path.string(),
              kSection, format);
  volume.type = format == 5.0 ? "uint16" : "float";
  volume.spacing = kMillimetre * keys.number("VoxelSizeRec");
  volume.data = data_of(path, keys.text("VOL_File"));
  return volume;
}

namespace {

bool recognises(const fs::path& path, const ReadOptions&) {
  return path.extension() == ".pcr" ||
         (path.extension() == ".vol" && is_there(fs::path(path).replace_extension(".pcr")));
}

std::vector<fs::path> files(const fs::path& path) {
  const fs::path parameters = fs::path(path).replace_extension(".pcr");
  return {path, parameters, read_pcr(parameters).data};
}

/// By its .pcr or by the .vol beside one.
Volume read(const fs::path& path, ReadOptions options) {
  const PhoenixVolume phoenix = read_pcr(fs::path(path).replace_extension(".pcr"));
  options.raw_size = phoenix.size;
  options.raw_type = phoenix.type;
  if (!options.spacing) options.spacing = phoenix.spacing;
  return read_headerless(path.extension() == ".vol" ? path : phoenix.data, options);
}

}  // namespace

VolumeFormat formats::phoenix() {
  return {.name = "GE phoenix (.pcr, or .vol beside one)",
          .recognises = recognises,
          .files = files,
          .read = read};
}

}  // namespace pendular
