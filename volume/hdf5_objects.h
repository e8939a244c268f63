#pragma once

#include <hdf5.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "volume/voxel_header.h"

namespace pendular {

// Groups, datasets and attributes of an HDF5 file. Internal to volume.

/// An object of the HDF5 library, closed when it goes.
class Hdf5 {
 public:
  Hdf5() = default;
  Hdf5(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5(Hdf5&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5& operator=(Hdf5&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  operator hid_t() const { return id_; }
  bool open() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// A file, and the object in it that its user names: "scan.h5:/entry/data"; empty: none is named.
struct Hdf5Address {
  fs::path file;
  std::string object;
};

/// What a path means if it is of an HDF5 file: by the extension .h5, .hdf5, .hdf, .nxs or .nx of the file, or
/// by its first bytes; nothing for any other path.
std::optional<Hdf5Address> hdf5_address(const fs::path& path);

/// Opened for reading; BadInput where it is no HDF5 file.
Hdf5 open_hdf5(const fs::path& file);

/// The dataset of an address: the object itself, or the signal of a NeXus NXdata group (its attribute
/// `signal`, else its dataset `data`). Where no object is named: by the attributes `default`, else the only
/// dataset of three dimensions. BadInput that lists these for any other object, and for a file of projections
/// (NXtomo) without a name.
struct Hdf5Dataset {
  Hdf5 set;
  std::string name;  ///< from the file's root
};
Hdf5Dataset find_dataset(const Hdf5& file, const Hdf5Address& address);

/// Where the voxels are: `element_size_um` (along z, y, x) of the dataset, else the coordinates x, y, z
/// beside it with their units, as in NXtomoproc. Nothing where neither is there.
std::optional<Placement> placement_of(const Hdf5& file, const Hdf5Dataset& data,
                                      const std::array<std::size_t, 3>& size, const fs::path& path);

}  // namespace pendular
