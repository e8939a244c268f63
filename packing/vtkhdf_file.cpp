#include "packing/vtkhdf_file.h"

#include <hdf5.h>

namespace pendular {
namespace {

constexpr std::uint8_t kVertex = 1, kLine = 3;  // VTK's numbers of cell types
constexpr hsize_t kChunk = 1 << 14;

/// An object of the HDF5 library, closed when it goes.
class Opened {
 public:
  Opened(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Opened() {
    if (id_ >= 0) close_(id_);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Writes into one file; remembers whether anything failed.
class Writer {
 public:
  explicit Writer(const fs::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose),
        root_(H5Gcreate2(file_, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose) {
    good_ = file_ >= 0 && root_ >= 0;
  }

  bool finish() { return good_ && H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0; }

  void attribute(const char* name, hid_t type, hsize_t count, const void* value) {
    const Opened space(count == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Opened made(H5Acreate2(root_, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    good_ &= made >= 0 && H5Awrite(made, type, value) >= 0;
  }

  void text_attribute(const char* name, const std::string& text) {
    const Opened type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, text.size());
    attribute(name, type, 0, text.data());
  }

  void group(const char* name) {
    const Opened made(H5Gcreate2(root_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    good_ &= made >= 0;
  }

  /// A dataset of rows of `width` numbers (1: of one dimension), compressed; without times, so that equal
  /// data give equal bytes.
  void dataset(const std::string& name, hid_t type, hsize_t rows, hsize_t width, const void* values) {
    const hsize_t extent[2] = {rows, width}, chunk[2] = {std::min(std::max<hsize_t>(rows, 1), kChunk), width};
    const int rank = width == 1 ? 1 : 2;
    const Opened space(H5Screate_simple(rank, extent, nullptr), H5Sclose),
        how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(how, false);
    if (rows > 1) {
      H5Pset_chunk(how, rank, chunk);
      H5Pset_deflate(how, 5);
    }
    const Opened made(H5Dcreate2(root_, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
    good_ &= made >= 0 && H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  }

  void text_dataset(const std::string& name, const std::string& text) {
    const Opened type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    const char* bytes = text.c_str();
    dataset(name, type, 1, 1, &bytes);
  }

  void array(const std::string& group, const std::string& name, const PolyTable::Array& values) {
    const std::string path = group + "/" + name;
    if (const auto* numbers = std::get_if<std::vector<double>>(&values))
      dataset(path, H5T_NATIVE_DOUBLE, numbers->size(), 1, numbers->data());
    else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&values))
      dataset(path, H5T_NATIVE_INT64, whole->size(), 1, whole->data());
    else
      points(path, std::get<std::vector<Vec3>>(values));
  }

  void points(const std::string& name, const std::vector<Vec3>& values) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    dataset(name, H5T_NATIVE_DOUBLE, values.size(), 3, values.data());
  }

 private:
  Opened file_, root_;
  bool good_ = true;
};

/// Lines, or a vertex per point where there are none.
void write_cells(Writer& file, const PolyTable& table) {
  std::vector<std::int64_t> ends, offsets = {0};
  for (const auto& [i, j] : table.lines) ends.insert(ends.end(), {i, j});
  const bool vertices = table.lines.empty();
  if (vertices)
    for (std::size_t k = 0; k < table.points.size(); ++k) ends.push_back(static_cast<std::int64_t>(k));
  const std::int64_t width = vertices ? 1 : 2, cells = static_cast<std::int64_t>(ends.size()) / width;
  for (std::int64_t k = 1; k <= cells; ++k) offsets.push_back(k * width);
  const std::vector<std::uint8_t> types(static_cast<std::size_t>(cells), vertices ? kVertex : kLine);
  const std::int64_t points = static_cast<std::int64_t>(table.points.size()),
                     connections = static_cast<std::int64_t>(ends.size());
  file.dataset("NumberOfPoints", H5T_NATIVE_INT64, 1, 1, &points);
  file.dataset("NumberOfCells", H5T_NATIVE_INT64, 1, 1, &cells);
  file.dataset("NumberOfConnectivityIds", H5T_NATIVE_INT64, 1, 1, &connections);
  file.dataset("Connectivity", H5T_NATIVE_INT64, ends.size(), 1, ends.data());
  file.dataset("Offsets", H5T_NATIVE_INT64, offsets.size(), 1, offsets.data());
  file.dataset("Types", H5T_NATIVE_UINT8, types.size(), 1, types.data());
}

}  // namespace

bool write_vtkhdf_file(const fs::path& path, const PolyTable& table) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Writer file(path);
  const std::array<std::int64_t, 2> version{1, 0};
  file.attribute("Version", H5T_NATIVE_INT64, 2, version.data());
  file.text_attribute("Type", "UnstructuredGrid");
  file.points("Points", table.points);
  write_cells(file, table);
  for (const char* group : {"PointData", "CellData", "FieldData"}) file.group(group);
  for (const auto& [name, values] : table.point_data) file.array("PointData", name, values);
  if (!table.lines.empty())
    for (const auto& [name, values] : table.line_data) file.array("CellData", name, values);
  for (const auto& [name, value] : table.number_fields)
    file.dataset("FieldData/" + name, H5T_NATIVE_DOUBLE, 1, 1, &value);
  for (const auto& [name, text] : table.text_fields) file.text_dataset("FieldData/" + name, text);
  return file.finish();
}

}  // namespace pendular
