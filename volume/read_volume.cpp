#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "volume/image_io.h"
#include "volume/phoenix.h"
#include "volume/read_dicom.h"
#include "volume/read_slices.h"
#include "volume/volume.h"

namespace pendular {
namespace {

static_assert(std::endian::native == std::endian::little, "headerless files are read as little endian");

bool is_meta(const std::string& extension) {
  return extension == ".mha" || extension == ".mhd";
}

bool is_nrrd(const std::string& extension) {
  return extension == ".nrrd" || extension == ".nhdr";
}

/// A MetaImage or NRRD, whose header is read here.
Volume read_with_header(const VoxelHeader& header, const fs::path& path, const ReadOptions& options) {
  Volume volume;
  volume.size = header.size;
  volume.pixels = header.pixels;
  const auto edges = place(volume, &header.place, path, options);
  read_voxels(header, path, volume);
  return made_cubic(std::move(volume), edges, path);
}

/// Pages of a TIFF. Its resolution tag is a printer's and rarely the scanner's.
Volume read_pages(const fs::path& path, const ReadOptions& options) {
  const auto io = reader_of(path);
  read_header(*io, path);
  if (io->GetNumberOfDimensions() != 3)
    bad_input("{}: found an image of {} dimensions, expected 3", path.string(), io->GetNumberOfDimensions());
  Volume volume;
  volume.pixels = pixels_of(io->GetComponentType(), path);
  for (unsigned axis = 0; axis < 3; ++axis) volume.size[axis] = io->GetDimensions(axis);
  place(volume, nullptr, path, options);
  allocate(volume, path, fs::file_size(path));
  read_pixels(*io, path, bytes(volume));
  return volume;
}

Volume read_one_file(const fs::path& path, const ReadOptions& options) {
  const std::string extension = lower_extension(path);
  if (is_meta(extension)) return read_with_header(read_meta_header(path), path, options);
  if (is_nrrd(extension)) return read_with_header(read_nrrd_header(path), path, options);
  return read_pages(path, options);
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
  volume.file = std::make_shared<MappedFile>(path);
  if (volume.file->size() != size)
    bad_input("{}: found {} bytes, expected {} as before: the file is being written", path.string(),
              volume.file->size(), size);
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

void check_numbers(std::span<const Grey<float>> pixels, const Volume& volume, const std::string& where) {
  std::atomic<std::size_t> bad{pixels.size()};
  for_blocks(pixels.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
    std::size_t here = first;
    while (here < last && std::isfinite(static_cast<float>(pixels[here]))) ++here;
    for (std::size_t least = bad; here < last && here < least && !bad.compare_exchange_weak(least, here);) {
    }
  });
  if (bad < pixels.size())
    bad_input("{}: voxel ({}, {}, {}): found NaN or infinity, expected a number", where, bad % volume.size[0],
              bad / volume.size[0] % volume.size[1], bad / (volume.size[0] * volume.size[1]));
}

}  // namespace

void check_pixels(const Volume& volume, const std::string& where) {
  with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    if constexpr (std::is_same_v<T, float>) check_numbers(pixels, volume, where);
    const T grey = pixels[0];
    if (std::none_of(pixels.begin(), pixels.end(), [&](T other) { return other != grey; }))
      bad_input("{}: found one grey value throughout ({}), expected beads", where, grey);
  });
  release(volume);
}

std::vector<fs::path> volume_files(const fs::path& path) {
  require_readable(path, true);
  std::vector<fs::path> files = {path};
  const std::string extension = lower_extension(path);
  if (fs::is_directory(path)) return is_dicom(path) ? files_in(path) : slice_files(path);
  if (is_meta(extension) || is_nrrd(extension)) {
    const auto header = is_meta(extension) ? read_meta_header(path) : read_nrrd_header(path);
    files.insert(files.end(), header.files.begin(), header.files.end());
  } else if (is_phoenix(path)) {
    const fs::path parameters = fs::path(path).replace_extension(".pcr");
    files.insert(files.end(), {parameters, read_pcr(parameters).data});
  }
  return files;
}

Volume read_volume(const fs::path& path, const ReadOptions& options) {
  require_readable(path, true);
  if (options.raw_size && fs::is_directory(path))
    throw BadUsage("--size: found a folder of slices, expected headerless data");
  Volume volume = is_dicom(path)           ? read_dicom(path, options)
                  : fs::is_directory(path) ? read_slices(path, options)
                  : options.raw_size       ? read_raw(path, options)
                  : is_phoenix(path)       ? read_phoenix(path, options)
                                           : read_one_file(path, options);
  check_pixels(volume, path.string());
  return volume;
}

}  // namespace pendular
