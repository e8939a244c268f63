#include "volume/read_zarr.h"

#include <blosc.h>

#include <algorithm>

#include "base/error.h"
#include "base/inflate.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/path_kind.h"
#include "base/progress.h"
#include "volume/format.h"
#include "volume/pixels.h"
#include "volume/place.h"
#include "volume/zarr_array.h"

namespace pendular {
namespace {

using Place = std::array<std::size_t, 3>;  // along x, y, z

Place chunks_along(const ZarrArray& zarr) {
  Place count;
  for (std::size_t axis = 0; axis < 3; ++axis) count[axis] = (zarr.size[axis] - 1) / zarr.chunk[axis] + 1;
  return count;
}

template <typename Visit>
void for_each_chunk(const ZarrArray& zarr, const Visit& visit) {
  const Place count = chunks_along(zarr);
  for (std::size_t z = 0; z < count[2]; ++z)
    for (std::size_t y = 0; y < count[1]; ++y)
      for (std::size_t x = 0; x < count[0]; ++x) visit(Place{x, y, z});
}

/// Bytes that a chunk says it inflates to, or that deflate cannot exceed; its file is there.
std::uintmax_t bytes_behind(const ZarrArray& zarr, const fs::path& file) {
  if (!is_file(file)) bad_input("{}: found no such chunk, expected every chunk of the array", file.string());
  const std::uintmax_t stored = fs::file_size(file);
  if (zarr.codec != ZarrArray::Codec::blosc) return stored;
  const MappedFile chunk(file);
  std::size_t bytes = 0;
  if (blosc_cbuffer_validate(chunk.data(), chunk.size(), &bytes) != 0 || bytes != zarr.chunk_bytes())
    bad_input("{}: found a damaged chunk, expected {} bytes by blosc", file.string(), zarr.chunk_bytes());
  return bytes;
}

/// Bytes that a blosc chunk holds, taken into `room`; 0 where it is damaged or holds another number of them.
std::uint64_t unblosced(std::span<const std::byte> stored, std::span<std::byte> room) {
  std::size_t bytes = 0;
  if (blosc_cbuffer_validate(stored.data(), stored.size(), &bytes) != 0 || bytes != room.size()) return 0;
  return static_cast<std::uint64_t>(
      std::max(0, blosc_decompress_ctx(stored.data(), room.data(), room.size(), 1)));
}

/// A chunk's numbers as they lie there, inflated into `room` where they must be.
std::span<const std::byte> inflated(const ZarrArray& zarr, const fs::path& file, const MappedFile& chunk,
                                    std::vector<std::byte>& room) {
  const std::size_t expected = zarr.chunk_bytes();
  const std::span<const std::byte> stored(chunk.data(), chunk.size());
  std::uint64_t found = stored.size();
  if (zarr.codec != ZarrArray::Codec::none) {
    room.resize(expected);
    found = zarr.codec == ZarrArray::Codec::deflate ? inflate_into(stored, room) : unblosced(stored, room);
  }
  if (found != expected)
    bad_input("{}: found {} bytes in a chunk, expected {}: truncated or damaged", file.string(), found,
              expected);
  return zarr.codec == ZarrArray::Codec::none ? stored : std::span<const std::byte>(room);
}

/// Copies what a chunk has of the volume; beyond the volume's ends it is padded.
void copy_chunk(const ZarrArray& zarr, const Place& at, std::span<const std::byte> numbers, Volume& volume) {
  Place first, count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = at[axis] * zarr.chunk[axis];
    count[axis] = std::min(zarr.chunk[axis], zarr.size[axis] - first[axis]);
  }
  const std::size_t width = width_of(zarr.type);
  for (std::size_t z = 0; z < count[2]; ++z)
    for (std::size_t y = 0; y < count[1]; ++y)
      convert(numbers.subspan((z * zarr.chunk[1] + y) * zarr.chunk[0] * width, count[0] * width), zarr.type,
              zarr.big_endian, volume,
              ((first[2] + z) * volume.size[1] + first[1] + y) * volume.size[0] + first[0]);
}

/// All chunks with the same z, by as many threads as there are.
void read_layer(const ZarrArray& zarr, std::size_t z, Volume& volume) {
  const Place count = chunks_along(zarr);
  for_blocks(count[0] * count[1], 1, [&](std::size_t k, std::size_t) {
    const Place at{k % count[0], k / count[0], z};
    const fs::path file = zarr.chunk_file(at);
    const MappedFile chunk(file);
    std::vector<std::byte> room;
    copy_chunk(zarr, at, inflated(zarr, file, chunk, room), volume);
  });
}

}  // namespace

std::vector<fs::path> zarr_files(const fs::path& folder) {
  const ZarrArray zarr = read_zarr_metadata(folder);
  std::vector<fs::path> files = zarr.metadata;
  for_each_chunk(zarr, [&](const Place& at) { files.push_back(zarr.chunk_file(at)); });
  return files;
}

Volume read_zarr(const fs::path& folder, const ReadOptions& options) {
  const ZarrArray zarr = read_zarr_metadata(folder);
  Volume volume;
  volume.size = zarr.size;
  volume.pixels = pixels_of(zarr.type);
  const auto edges = place(volume, zarr.place ? &*zarr.place : nullptr, folder, options);
  std::uintmax_t there = 0;
  for_each_chunk(zarr, [&](const Place& at) { there += bytes_behind(zarr, zarr.chunk_file(at)); });
  allocate(volume, folder, there);
  const std::size_t layers = chunks_along(zarr)[2];
  Progress progress("reading chunks", static_cast<double>(layers));
  for (std::size_t z = 0; z < layers; ++z) {
    stop_if_interrupted();
    read_layer(zarr, z, volume);
    progress.update(static_cast<double>(z + 1));
  }
  return made_cubic(std::move(volume), edges, folder);
}

VolumeFormat formats::zarr() {
  return {.name = "a folder of OME-Zarr",
          .recognises = [](const fs::path& path, const ReadOptions&) { return is_zarr(path); },
          .files = zarr_files,
          .read = read_zarr};
}

}  // namespace pendular
