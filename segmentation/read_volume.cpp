#include <atomic>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "segmentation/image_io.h"
#include "segmentation/phoenix.h"
#include "segmentation/read_dicom.h"
#include "segmentation/read_slices.h"
#include "segmentation/volume.h"

namespace pendular {
namespace {

static_assert(std::endian::native == std::endian::little, "headerless files are read as little endian");

/// MetaIO reads truncated data without an error, so the amount of data is checked here.
/// `voxel_bytes`: what the header asks for.
void check_metaimage_data(const fs::path& header, std::uintmax_t voxel_bytes) {
  std::ifstream in(header, std::ios::binary);
  std::map<std::string, std::string> field;
  constexpr int most_lines = 1000;
  std::string line;
  for (int k = 0; k < most_lines && !field.count("ElementDataFile") && std::getline(in, line); ++k) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    const auto trimmed = [](std::string word) {
      word.erase(0, word.find_first_not_of(" \t\r"));
      word.erase(word.find_last_not_of(" \t\r") + 1);
      return word;
    };
    field[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  const std::string file = field["ElementDataFile"];
  if (file == "LIST" || file.find('%') != std::string::npos) return;
  const bool local = file == "LOCAL" || file == "Local" || file == "local";
  const fs::path data = local ? header : header.parent_path() / file;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(data, error);
  if (error)
    bad_input("{}: ElementDataFile: found no file '{}', expected the voxels there", header.string(),
              data.string());
  const bool compressed = !field["CompressedData"].empty() && std::toupper(field["CompressedData"][0]) == 'T';
  if (compressed && field["CompressedDataSize"].empty()) return;
  const std::uintmax_t expected =
      compressed ? std::strtoull(field["CompressedDataSize"].c_str(), nullptr, 10) : voxel_bytes;
  std::uintmax_t skipped = local ? static_cast<std::uintmax_t>(in.tellg()) : 0;
  if (!field["HeaderSize"].empty() && !local)
    skipped = std::max(0LL, std::atoll(field["HeaderSize"].c_str()));
  if (size - std::min(size, skipped) != expected)
    bad_input("{}: found {} bytes of voxels, expected {}: truncated, or DimSize or ElementType do not match",
              data.string(), size - std::min(size, skipped), expected);
}

Volume read_one_file(const fs::path& path, const ReadOptions& options) {
  const auto io = reader_of(path);
  read_header(*io, path);
  unsigned dimensions = io->GetNumberOfDimensions();
  while (dimensions > 3 && io->GetDimensions(dimensions - 1) == 1) --dimensions;
  if (dimensions != 3)
    bad_input("{}: found an image of {} dimensions, expected 3", path.string(), dimensions);
  Volume volume;
  volume.pixels = pixels_of(io->GetComponentType(), path);
  for (unsigned axis = 0; axis < 3; ++axis) volume.size[axis] = io->GetDimensions(axis);
  const std::string extension = lower_extension(path);
  const bool meta = extension == ".mha" || extension == ".mhd";
  if (meta) {
    std::uintmax_t voxels = 1;
    for (const std::size_t n : volume.size) voxels *= n;
    check_metaimage_data(path, voxels * bytes_per_voxel(volume));
  }
  const bool detached = extension == ".mhd" || extension == ".nhdr";
  allocate(volume, path, detached ? std::numeric_limits<std::uintmax_t>::max() : fs::file_size(path));
  // The resolution tag of a TIFF is a printer's and rarely the scanner's.
  const bool spacing_is_meant = meta || extension == ".nrrd" || extension == ".nhdr";
  place(volume, spacing_is_meant ? io.GetPointer() : nullptr, path, options);
  read_pixels(*io, path, bytes(volume));
  return volume;
}

Volume read_raw(const fs::path& path, const ReadOptions& options) {
  Volume volume;
  volume.size = *options.raw_size;
  volume.pixels = pixels_of(options.raw_type);
  if (!options.spacing)
    throw BadUsage("--voxel-um: found nothing, expected the voxel size of headerless data");
  double expected = static_cast<double>(bytes_per_voxel(volume));
  for (const std::size_t n : volume.size) expected *= static_cast<double>(n);
  const auto size = fs::file_size(path);
  if (static_cast<double>(size) != expected)
    bad_input("{}: found {} bytes, expected {:.0f} for {} x {} x {} voxels of {}", path.string(), size,
              expected, volume.size[0], volume.size[1], volume.size[2], options.raw_type);
  allocate(volume, path, size);
  place(volume, nullptr, path, options);
  std::ifstream in(path, std::ios::binary);
  if (!in.read(bytes(volume), static_cast<std::streamsize>(size)))
    bad_input("{}: found data that ends early, expected {} bytes", path.string(), size);
  return volume;
}

/// A GE phoenix volume, by its .pcr or by the .vol beside one.
Volume read_phoenix(const fs::path& path, ReadOptions options) {
  const PhoenixVolume phoenix = read_pcr(fs::path(path).replace_extension(".pcr"));
  options.raw_size = phoenix.size;
  options.raw_type = phoenix.type;
  if (!options.spacing) options.spacing = phoenix.spacing;
  return read_raw(path.extension() == ".vol" ? path : phoenix.data, options);
}

/// Whether a file is a GE phoenix reconstruction.
bool is_phoenix(const fs::path& path) {
  return path.extension() == ".pcr" ||
         (path.extension() == ".vol" && fs::exists(fs::path(path).replace_extension(".pcr")));
}

/// Every grey value a number, and more than one of them.
void check_pixels(const Volume& volume, const fs::path& path) {
  with_pixels(volume, [&](auto pixels) {
    std::atomic<std::size_t> bad{pixels.size()};
    std::atomic<bool> varies{false};
    for_blocks(pixels.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
      bool differs = false;
      std::size_t here = pixels.size();
      for (std::size_t k = first; k < last; ++k) {
        differs |= pixels[k] != pixels[0];
        if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(pixels[0])>>)
          if (here == pixels.size() && !std::isfinite(pixels[k])) here = k;
      }
      if (differs) varies = true;
      for (std::size_t least = bad; here < least && !bad.compare_exchange_weak(least, here);) {
      }
    });
    if (bad < pixels.size())
      bad_input("{}: voxel ({}, {}, {}): found NaN or infinity, expected a number", path.string(),
                bad % volume.size[0], bad / volume.size[0] % volume.size[1],
                bad / (volume.size[0] * volume.size[1]));
    if (!varies)
      bad_input("{}: found one grey value throughout ({}), expected beads", path.string(), pixels[0]);
  });
}

}  // namespace

Volume read_volume(const fs::path& path, const ReadOptions& options) {
  require_readable(path, true);
  if (options.raw_size && fs::is_directory(path))
    throw BadUsage("--size: found a folder of slices, expected headerless data");
  Volume volume = is_dicom(path)           ? read_dicom(path, options)
                  : fs::is_directory(path) ? read_slices(path, options)
                  : options.raw_size       ? read_raw(path, options)
                  : is_phoenix(path)       ? read_phoenix(path, options)
                                           : read_one_file(path, options);
  check_pixels(volume, path);
  return volume;
}

}  // namespace pendular
