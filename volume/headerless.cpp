#include "volume/headerless.h"

#include <bit>

#include "base/error.h"
#include "base/path_kind.h"
#include "volume/format.h"
#include "volume/pixels.h"
#include "volume/place.h"

namespace pendular {

static_assert(std::endian::native == std::endian::little, "headerless files are read as little endian");

Volume read_headerless(const fs::path& path, const ReadOptions& options) {
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

VolumeFormat formats::headerless() {
  return {.name = "raw data of a stated size",
          .recognises = [](const fs::path& path,
                           const ReadOptions& options) { return options.raw_size && !is_folder(path); },
          .read = read_headerless};
}

}  // namespace pendular
