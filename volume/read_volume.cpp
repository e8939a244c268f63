#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/path_kind.h"
#include "volume/format.h"
#include "volume/read_hdf5.h"

namespace pendular {
namespace {

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

fs::path volume_place(const fs::path& path) {
  return hdf5_file(path).value_or(path);
}

std::vector<fs::path> volume_files(const fs::path& path) {
  require_readable(volume_place(path), true);
  const VolumeFormat* format = format_of(path);
  return format && format->files ? format->files(path) : std::vector<fs::path>{path};
}

Volume read_volume(const fs::path& path, const ReadOptions& options) {
  require_readable(volume_place(path), true);
  if (options.raw_size && is_folder(path))
    throw BadUsage("--size: found a folder of slices, expected headerless data");
  const VolumeFormat* format = format_of(path, options);
  if (!format)
    bad_input("{}: found extension '{}', expected {}", path.string(), lower_extension(path), format_names());
  Volume volume = format->read(path, options);
  check_pixels(volume, path.string());
  return volume;
}

}  // namespace pendular
