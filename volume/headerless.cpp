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
  const auto type = stored_named(options.raw_type);
  if (!type) throw BadUsage(fmt::format("--type: found '{}', expected {}", options.raw_type, kStoredTypes));
  volume.pixels = pixels_of(*type);
  if (!options.spacing)
    throw BadUsage("--voxel-um: found nothing, expected the voxel size of headerless data");
  double expected = static_cast<double>(width_of(*type));
  for (const std::size_t n : volume.size) expected *= static_cast<double>(n);
  const auto size = fs::file_size(path);
  if (static_cast<double>(size) != expected)
    bad_input("{}: found {} bytes, expected {:.0f} for {} x {} x {} voxels of {}", path.string(), size,
              expected, volume.size[0], volume.size[1], volume.size[2], options.raw_type);
  place(volume, nullptr, path, options);
  const auto file = std::make_shared<MappedFile>(path);
  if (file->size() != size)
    bad_input("{}: found {} bytes, expected {} as before: the file is being written", path.string(),
              file->size(), size);
  if (is_kept(*type)) {
    volume.file = file;
  } else {
    allocate(volume, path, size);
    convert({file->data(), size}, *type, false, volume, 0);
  }
  return volume;
}

VolumeFormat formats::headerless() {
  return {.name = "raw data of a stated size",
          .recognises = [](const fs::path& path,
                           const ReadOptions& options) { return options.raw_size && !is_folder(path); },
          .read = read_headerless};
}

}  // namespace pendular
