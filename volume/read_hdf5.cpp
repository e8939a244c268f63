#include "volume/read_hdf5.h"

#include <algorithm>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "volume/format.h"
#include "volume/hdf5_objects.h"
#include "volume/pixels.h"
#include "volume/place.h"

namespace pendular {
namespace {

constexpr std::size_t kSlabBytes = std::size_t{64} << 20;

/// A dataset's dimensions and chunks, slowest first as HDF5 counts them.
struct Layout {
  std::vector<hsize_t> extent, chunk;  ///< chunk: empty where the dataset has none
  std::size_t leading = 0;             ///< dimensions of length 1 before z
};

Layout layout_of(const Hdf5& set, const std::string& where) {
  Layout layout;
  const Hdf5 space(H5Dget_space(set), H5Sclose), how(H5Dget_create_plist(set), H5Pclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  layout.extent.resize(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space, layout.extent.data(), nullptr);
  while (layout.extent.size() - layout.leading > 3 && layout.extent[layout.leading] == 1) ++layout.leading;
  if (layout.extent.size() - layout.leading != 3)
    bad_input("{}: found dimensions ({}), expected three: z, y, x", where, fmt::join(layout.extent, ", "));
  if (H5Pget_layout(how) == H5D_VIRTUAL || H5Pget_external_count(how) > 0)
    bad_input("{}: found a dataset whose voxels other files hold, expected them in its own", where);
  if (H5Pget_layout(how) == H5D_CHUNKED) {
    layout.chunk.resize(layout.extent.size());
    H5Pget_chunk(how, rank, layout.chunk.data());
  }
  for (int k = 0; k < H5Pget_nfilters(how); ++k) {
    unsigned flags = 0, about = 0;
    std::size_t values = 0;
    char name[64] = "";
    const auto filter =
        H5Pget_filter2(how, static_cast<unsigned>(k), &flags, &values, nullptr, sizeof name, name, &about);
    if (H5Zfilter_avail(filter) <= 0)
      bad_input(
          "{}: found filter {} ({}), which is not installed, expected gzip, szip or none: h5repack -f GZIP=1",
          where, static_cast<int>(filter), name);
  }
  return layout;
}

/// No pixels yet, of the type that a dataset is read as.
Volume::Pixels pixels_for(const Hdf5& set, const std::string& where) {
  const Hdf5 type(H5Dget_type(set), H5Tclose);
  const std::size_t size = H5Tget_size(type);
  const auto kind = H5Tget_class(type);
  if (kind == H5T_FLOAT && size <= 8) return std::vector<float>();
  if (kind == H5T_INTEGER) {
    const bool has_sign = H5Tget_sign(type) == H5T_SGN_2;
    if (!has_sign && size == 1) return std::vector<std::uint8_t>();
    if (!has_sign && size == 2) return std::vector<std::uint16_t>();
    if (!has_sign && size == 4) return std::vector<std::uint32_t>();
    if (size <= 8) return std::vector<float>();
  }
  bad_input("{}: found {} of {} bytes, expected {}", where,
            kind == H5T_INTEGER ? "integers"
            : kind == H5T_FLOAT ? "floats"
                                : "something else than numbers",
            size, kStoredTypes);
}

hid_t type_in_memory(const Volume& volume) {
  constexpr std::array<hid_t (*)(), 4> types = {
      [] { return hid_t{H5T_NATIVE_UINT8}; }, [] { return hid_t{H5T_NATIVE_UINT16}; },
      [] { return hid_t{H5T_NATIVE_FLOAT}; }, [] { return hid_t{H5T_NATIVE_UINT32}; }};
  return types[volume.pixels.index()]();
}

/// Chunks that were never written would be read as the fill value.
void require_chunks(const Hdf5& set, const Layout& layout, const std::string& where) {
  hsize_t expected = 1, found = 0;
  for (std::size_t k = 0; k < layout.chunk.size(); ++k)
    expected *= (layout.extent[k] + layout.chunk[k] - 1) / layout.chunk[k];
  if (layout.chunk.empty()) {
    if (H5Dget_storage_size(set) == 0) bad_input("{}: found no voxels written, expected all", where);
    return;
  }
  const Hdf5 space(H5Dget_space(set), H5Sclose);
  if (H5Dget_num_chunks(set, space, &found) < 0 || found != expected)
    bad_input("{}: found {} chunks, expected {}: the dataset is incomplete", where, found, expected);
}

/// Where the voxels lie in the file as they lie in memory, they stay there.
bool stays_in_file(const Hdf5& file, const Hdf5& set, const Layout& layout, const fs::path& path,
                   Volume& volume) {
  const Hdf5 type(H5Dget_type(set), H5Tclose), made(H5Fget_create_plist(file), H5Pclose);
  hsize_t before = 0;
  if (!layout.chunk.empty() || H5Tequal(type, type_in_memory(volume)) <= 0 ||
      H5Pget_userblock(made, &before) < 0 || before != 0)
    return false;
  const haddr_t first = H5Dget_offset(set);
  if (first == HADDR_UNDEF) return false;
  auto mapped = std::make_shared<MappedFile>(path);
  const std::uint64_t bytes = std::uint64_t{bytes_per_voxel(volume)} * volume.voxels();
  if (first > mapped->size() || mapped->size() - first < bytes) return false;
  volume.file = std::move(mapped);
  volume.first_byte = first;
  return true;
}

void read_slabs(const Hdf5& set, const Layout& layout, const std::string& where, Volume& volume) {
  const std::size_t plane = bytes_per_voxel(volume) * volume.size[0] * volume.size[1];
  const std::size_t step = layout.chunk.empty() ? std::max<std::size_t>(1, kSlabBytes / plane)
                                                : static_cast<std::size_t>(layout.chunk[layout.leading]);
  const Hdf5 space(H5Dget_space(set), H5Sclose);
  Progress progress("reading slices", static_cast<double>(volume.size[2]));
  for (std::size_t z = 0; z < volume.size[2]; z += step) {
    stop_if_interrupted();
    std::vector<hsize_t> first(layout.extent.size(), 0), count = layout.extent;
    first[layout.leading] = z;
    count[layout.leading] = std::min(step, volume.size[2] - z);
    const Hdf5 memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr);
    if (H5Dread(set, type_in_memory(volume), memory, space, H5P_DEFAULT, bytes(volume) + z * plane) < 0)
      bad_input("{}: slices {} to {}: found damaged or truncated data, expected whole chunks", where, z,
                z + count[layout.leading] - 1);
    progress.update(static_cast<double>(z + count[layout.leading]));
  }
}

}  // namespace

std::optional<fs::path> hdf5_file(const fs::path& path) {
  const auto address = hdf5_address(path);
  if (!address) return std::nullopt;
  return address->file;
}

Volume read_hdf5(const fs::path& path, const ReadOptions& options) {
  const auto address = hdf5_address(path);
  if (!address) bad_input("{}: found no HDF5 file, expected one", path.string());
  const Hdf5 file = open_hdf5(address->file);
  const Hdf5Dataset data = find_dataset(file, *address);
  const std::string where = address->file.string() + ":" + data.name;
  const Layout layout = layout_of(data.set, where);
  Volume volume;
  volume.pixels = pixels_for(data.set, where);
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume.size[axis] = layout.extent[layout.extent.size() - 1 - axis];
  require_chunks(data.set, layout, where);
  const auto placement = placement_of(file, data, volume.size, where);
  const auto edges = place(volume, placement ? &*placement : nullptr, where, options);
  if (!stays_in_file(file, data.set, layout, address->file, volume)) {
    allocate(volume, where, H5Dget_storage_size(data.set));
    read_slabs(data.set, layout, where, volume);
  }
  return made_cubic(std::move(volume), edges, where);
}

VolumeFormat formats::hdf5() {
  return {.name = "HDF5 or NeXus with its dataset (scan.h5:/entry/data)",
          .recognises = [](const fs::path& path, const ReadOptions&) { return hdf5_file(path).has_value(); },
          .files = [](const fs::path& path) { return std::vector<fs::path>{*hdf5_file(path)}; },
          .read = read_hdf5};
}

}  // namespace pendular
