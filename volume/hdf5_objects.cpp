#include "volume/hdf5_objects.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/path_kind.h"
#include "volume/length_unit.h"

namespace pendular {
namespace {

constexpr std::size_t kListed = 6, kLongestText = 4096;

bool has_extension(const fs::path& file) {
  static const std::set<std::string> known = {".h5", ".hdf5", ".hdf", ".nxs", ".nx"};
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return known.contains(extension);
}

bool has_mark(const fs::path& file) {
  return is_file(file) && H5Fis_hdf5(file.c_str()) > 0;
}

/// The text of an attribute or dataset of one string, of fixed or variable length; empty where it is none.
std::string text_of(hid_t type, const auto& read) {
  if (H5Tget_class(type) != H5T_STRING) return "";
  std::string text;
  if (H5Tis_variable_str(type) > 0) {
    char* found = nullptr;
    const Hdf5 memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory, H5T_VARIABLE);
    H5Tset_cset(memory, H5Tget_cset(type));
    if (read(hid_t{memory}, static_cast<void*>(&found)) >= 0 && found != nullptr) text = found;
    H5free_memory(found);
    return text;
  }
  const std::size_t size = H5Tget_size(type);
  if (size > kLongestText) return "";
  text.resize(size);
  if (read(type, static_cast<void*>(text.data())) < 0) return "";
  text.resize(std::min(text.find('\0'), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Hdf5 attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Hdf5 type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (!attribute.open() || H5Sget_simple_extent_npoints(space) != 1) return "";
  return text_of(type, [&](hid_t memory, void* out) { return H5Aread(attribute, memory, out); });
}

/// Whether each part of a name leads on to an object that is there.
bool exists(hid_t file, const std::string& name) {
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (part != "/" && !part.empty() && H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) break;
  }
  return H5Oexists_by_name(file, name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5 open_object(hid_t file, const std::string& name) {
  return exists(file, name) ? Hdf5(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose) : Hdf5();
}

bool is_dataset(hid_t object) {
  return H5Iget_type(object) == H5I_DATASET;
}

int rank_of(hid_t set) {
  const Hdf5 space(H5Dget_space(set), H5Sclose);
  return H5Sget_simple_extent_ndims(space);
}

/// Names of the datasets that may be volumes.
std::vector<std::string> volumes_in(hid_t file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t root, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Hdf5 set(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
    if (set.open() && rank_of(set) >= 3)
      static_cast<std::vector<std::string>*>(found)->push_back(std::string("/") + name);
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC);
  return names;
}

std::string listed(hid_t file) {
  auto names = volumes_in(file);
  if (names.empty()) return "but it has no dataset of three dimensions";
  const bool more = names.size() > kListed;
  if (more) names.resize(kListed);
  return fmt::format("of three dimensions: {}{}", fmt::join(names, ", "), more ? ", ..." : "");
}

/// A group's signal; empty where it has none.
std::string signal_of(hid_t group, const std::string& name) {
  const std::string start = name == "/" ? name : name + "/";
  const std::string signal = attribute(group, "signal");
  for (const std::string& child : {signal, std::string("data")}) {
    if (child.empty() || child.find('/') != std::string::npos) continue;
    const Hdf5 found = open_object(group, child);
    if (found.open() && is_dataset(found)) return start + child;
  }
  return "";
}

bool holds_projections(hid_t file) {
  const Hdf5 root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  H5G_info_t info{};
  H5Gget_info(root, &info);
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    std::string name(kLongestText, '\0');
    const ssize_t length =
        H5Lget_name_by_idx(root, ".", H5_INDEX_NAME, H5_ITER_INC, k, name.data(), name.size(), H5P_DEFAULT);
    if (length <= 0 || static_cast<std::size_t>(length) >= kLongestText) continue;
    name.resize(static_cast<std::size_t>(length));
    const Hdf5 definition = open_object(file, "/" + name + "/definition");
    if (!definition.open() || !is_dataset(definition)) continue;
    const Hdf5 type(H5Dget_type(definition), H5Tclose), space(H5Dget_space(definition), H5Sclose);
    if (H5Sget_simple_extent_npoints(space) != 1) continue;
    const std::string text = text_of(type, [&](hid_t memory, void* out) {
      return H5Dread(definition, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
    });
    if (text == "NXtomo") return true;
  }
  return false;
}

/// Where the attributes `default` lead from the root; empty where they end at no signal.
std::string default_signal(hid_t file) {
  std::string name = "/";
  for (int depth = 0; depth < 8; ++depth) {
    const Hdf5 group = open_object(file, name);
    if (!group.open() || is_dataset(group)) return "";
    const std::string next = attribute(group, "default");
    if (next.empty()) return name == "/" ? "" : signal_of(group, name);
    name = next.front() == '/' ? next : fmt::format("{}/{}", name == "/" ? "" : name, next);
  }
  return "";
}

std::string unnamed(hid_t file, const Hdf5Address& address) {
  if (holds_projections(file))
    bad_input("{}: found projections (NXtomo), expected a reconstructed volume: name its dataset, {}:/...",
              address.file.string(), address.file.filename().string());
  if (std::string name = default_signal(file); !name.empty()) return name;
  const auto volumes = volumes_in(file);
  if (volumes.size() != 1)
    bad_input("{}: found no name of a dataset ({}:/...), expected one {}", address.file.string(),
              address.file.filename().string(), listed(file));
  return volumes.front();
}

std::vector<double> numbers_of(hid_t set) {
  const Hdf5 space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
  if (H5Tget_class(type) != H5T_FLOAT && H5Tget_class(type) != H5T_INTEGER) return {};
  if (H5Sget_simple_extent_ndims(space) != 1) return {};
  hsize_t length = 0;
  H5Sget_simple_extent_dims(space, &length, nullptr);
  if (length > 1 << 24) return {};
  std::vector<double> values(length);
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return {};
  return values;
}

std::optional<Placement> element_size(hid_t set, const fs::path& path) {
  constexpr const char* name = "element_size_um";
  if (H5Aexists(set, name) <= 0) return std::nullopt;
  const Hdf5 found(H5Aopen(set, name, H5P_DEFAULT), H5Aclose), space(H5Aget_space(found), H5Sclose);
  std::array<double, 3> edges{};  // along z, y, x
  if (H5Sget_simple_extent_npoints(space) != 3 || H5Aread(found, H5T_NATIVE_DOUBLE, edges.data()) < 0)
    bad_input("{}: {}: found no three numbers, expected edges along z, y, x", path.string(), name);
  Placement place;
  place.unit = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.spacing[axis] = 1e-6 * edges[2 - axis];
    if (!(place.spacing[axis] > 0.0) || !std::isfinite(place.spacing[axis]))
      bad_input("{}: {}: found {}, expected positive numbers", path.string(), name, edges[2 - axis]);
  }
  return place;
}

}  // namespace

std::optional<Hdf5Address> hdf5_address(const fs::path& path) {
  if (is_there(path)) {
    if (is_folder(path) || (!has_extension(path) && !has_mark(path))) return std::nullopt;
    return Hdf5Address{path, ""};
  }
  const std::string text = path.string();
  const std::size_t at = text.rfind(":/");
  if (at == std::string::npos) {
    if (has_extension(path)) return Hdf5Address{path, ""};
    return std::nullopt;
  }
  const fs::path file = text.substr(0, at);
  if (!has_extension(file) && !is_file(file)) return std::nullopt;
  std::string object = text.substr(at + 1);
  while (object.size() > 1 && object.back() == '/') object.pop_back();
  return Hdf5Address{file, object};
}

Hdf5 open_hdf5(const fs::path& file) {
  require_readable(file);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what is wrong is said in one line, by us
  if (H5Fis_hdf5(file.c_str()) <= 0) bad_input("{}: found no HDF5 file, expected one", file.string());
  const Hdf5 how(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(how, false, true);
  Hdf5 opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, how), H5Fclose);
  if (!opened.open()) bad_input("{}: found a damaged HDF5 file, expected a whole one", file.string());
  return opened;
}

Hdf5Dataset find_dataset(const Hdf5& file, const Hdf5Address& address) {
  std::string name = address.object.empty() ? unnamed(file, address) : address.object;
  Hdf5 object = open_object(file, name);
  if (object.open() && H5Iget_type(object) == H5I_GROUP) {
    name = signal_of(object, name);
    object = name.empty() ? Hdf5() : open_object(file, name);
  }
  if (!object.open() || !is_dataset(object))
    bad_input("{}: found no dataset {}, expected one {}", address.file.string(),
              address.object.empty() ? name : address.object, listed(file));
  return {Hdf5(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), name};
}

std::optional<Placement> placement_of(const Hdf5& file, const Hdf5Dataset& data,
                                      const std::array<std::size_t, 3>& size, const fs::path& path) {
  if (const auto found = element_size(data.set, path)) return found;
  const std::string group = data.name.substr(0, data.name.rfind('/') + 1);
  Placement place;
  place.unit = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = group + "xyz"[axis];
    const Hdf5 coordinates = open_object(file, name);
    if (!coordinates.open() || !is_dataset(coordinates)) return std::nullopt;
    const auto at = numbers_of(coordinates);
    const std::string unit = attribute(coordinates, "units");
    if (at.size() != size[axis] || at.size() < 2 || unit.empty()) return std::nullopt;
    const double metres = length_unit(unit);
    if (metres == 0.0)
      bad_input("{}: {}: found unit \"{}\", expected a unit of length", path.string(), name, unit);
    const double step = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
    if (!(step > 0.0) || !std::isfinite(step))
      bad_input("{}: {}: found coordinates that do not rise, expected rising ones", path.string(), name);
    place.spacing[axis] = step * metres;
    place.origin[axis] = at.front() * metres;
  }
  return place;
}

}  // namespace pendular
