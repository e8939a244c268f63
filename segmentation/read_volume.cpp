#include <algorithm>
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

/// Fields of a MetaImage's header, and where it ends.
struct MetaHeader {
  std::map<std::string, std::string> field;
  std::size_t bytes = 0;

  bool says(const std::string& name) const {
    const auto found = field.find(name);
    return found != field.end() && !found->second.empty() && std::toupper(found->second[0]) == 'T';
  }
};

MetaHeader meta_header(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  MetaHeader header;
  constexpr int most_lines = 1000;
  std::string line;
  for (int k = 0; k < most_lines && !header.field.count("ElementDataFile") && std::getline(in, line); ++k) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    const auto trimmed = [](std::string word) {
      word.erase(0, word.find_first_not_of(" \t\r"));
      word.erase(word.find_last_not_of(" \t\r") + 1);
      return word;
    };
    header.field[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  header.bytes = static_cast<std::size_t>(std::max<std::streamoff>(0, in.tellg()));
  return header;
}

/// Where voxels lie in a file as they are in memory.
struct PlainData {
  fs::path file;
  std::size_t first_byte = 0;
};

/// MetaIO reads truncated data without an error, so the amount of data is checked here. None if the data are
/// not plain.
/// `voxel_bytes`: what the header asks for.
std::optional<PlainData> metaimage_data(const fs::path& path, std::uintmax_t voxel_bytes) {
  MetaHeader header = meta_header(path);
  const std::string file = header.field["ElementDataFile"];
  if (file == "LIST" || file.find('%') != std::string::npos) return std::nullopt;
  const bool local = file == "LOCAL" || file == "Local" || file == "local";
  const fs::path data = local ? path : path.parent_path() / file;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(data, error);
  if (error)
    bad_input("{}: ElementDataFile: found no file '{}', expected the voxels there", path.string(),
              data.string());
  const bool compressed = header.says("CompressedData");
  const std::string shrunk = header.field["CompressedDataSize"];
  if (compressed && shrunk.empty()) return std::nullopt;
  const std::uintmax_t expected = compressed ? std::strtoull(shrunk.c_str(), nullptr, 10) : voxel_bytes;
  std::uintmax_t skipped = local ? header.bytes : 0;
  const std::string stated = header.field["HeaderSize"];
  if (!stated.empty() && !local)
    skipped = static_cast<std::uintmax_t>(std::max(0LL, std::atoll(stated.c_str())));
  if (size - std::min(size, skipped) != expected)
    bad_input("{}: found {} bytes of voxels, expected {}: truncated, or DimSize or ElementType do not match",
              data.string(), size - std::min(size, skipped), expected);
  const bool plain = !compressed && header.says("BinaryData") && !header.says("BinaryDataByteOrderMSB") &&
                     !header.says("ElementByteOrderMSB");
  return plain ? std::optional(PlainData{data, skipped}) : std::nullopt;
}

void map_pixels(Volume& volume, const PlainData& data) {
  volume.file = std::make_shared<MappedFile>(data.file);
  volume.first_byte = data.first_byte;
  if (volume.file->size() - data.first_byte != volume.voxels() * bytes_per_voxel(volume))
    bad_input("{}: found {} bytes, expected as many as before: the file is being written", data.file.string(),
              volume.file->size());
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
  std::optional<PlainData> plain;
  if (meta) {
    std::uintmax_t voxels = 1;
    for (const std::size_t n : volume.size) voxels *= n;
    plain = metaimage_data(path, voxels * bytes_per_voxel(volume));
  }
  const bool detached = extension == ".mhd" || extension == ".nhdr";
  const auto least_bytes = detached ? std::numeric_limits<std::uintmax_t>::max() : fs::file_size(path);
  // The resolution tag of a TIFF is a printer's and rarely the scanner's.
  const bool spacing_is_meant = meta || extension == ".nrrd" || extension == ".nhdr";
  const auto edges = place(volume, spacing_is_meant ? io.GetPointer() : nullptr, path, options);
  if (plain) {
    map_pixels(volume, *plain);
  } else {
    allocate(volume, path, least_bytes);
    read_pixels(*io, path, bytes(volume));
  }
  return made_cubic(std::move(volume), edges, path);
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
  place(volume, nullptr, path, options);
  map_pixels(volume, {path, 0});
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

void check_numbers(std::span<const Grey<float>> pixels, const Volume& volume, const fs::path& path) {
  std::atomic<std::size_t> bad{pixels.size()};
  for_blocks(pixels.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
    std::size_t here = first;
    while (here < last && std::isfinite(static_cast<float>(pixels[here]))) ++here;
    for (std::size_t least = bad; here < last && here < least && !bad.compare_exchange_weak(least, here);) {
    }
  });
  if (bad < pixels.size())
    bad_input("{}: voxel ({}, {}, {}): found NaN or infinity, expected a number", path.string(),
              bad % volume.size[0], bad / volume.size[0] % volume.size[1],
              bad / (volume.size[0] * volume.size[1]));
}

/// Every grey value a number, and more than one of them.
void check_pixels(const Volume& volume, const fs::path& path) {
  with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    if constexpr (std::is_same_v<T, float>) check_numbers(pixels, volume, path);
    const T grey = pixels[0];
    if (std::none_of(pixels.begin(), pixels.end(), [&](T other) { return other != grey; }))
      bad_input("{}: found one grey value throughout ({}), expected beads", path.string(), grey);
  });
  release(volume);
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
