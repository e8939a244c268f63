#include "packing/polydata.h"

#include <dlfcn.h>

#include "base/error.h"
#include "packing/polydata_files.h"

namespace pendular {
namespace {

const PolydataFiles& polydata_files() {
  static const auto* files = [] {
    void* library = ::dlopen(PENDULAR_POLYDATA, RTLD_NOW | RTLD_LOCAL);
    void* found = library == nullptr ? nullptr : ::dlsym(library, "pendular_polydata_files");
    if (found == nullptr) throw ComputationFailed(fmt::format("VTK files: {}", ::dlerror()));
    return static_cast<const PolydataFiles*>(found);
  }();
  return *files;
}

template <typename T>
const T* find_array(const PolyTable& table, bool of_points, const std::string& name, const fs::path& path,
                    const PolyTable::Array** other = nullptr) {
  for (const auto& [key, array] : of_points ? table.point_data : table.line_data) {
    if (key != name) continue;
    if (other != nullptr) *other = &array;
    return std::get_if<T>(&array);
  }
  bad_input("{}: {} array {} is missing", path.string(), of_points ? "point" : "line", name);
}

}  // namespace

void write_polydata(const fs::path& path, const PolyTable& table) {
  polydata_files().write(path, table);
}

PolyTable read_polydata(const fs::path& path) {
  return polydata_files().read(path);
}

std::vector<double> numbers(const PolyTable& table, bool of_points, const std::string& name,
                            const fs::path& path) {
  const PolyTable::Array* other = nullptr;
  if (const auto* values = find_array<std::vector<double>>(table, of_points, name, path, &other))
    return *values;
  if (const auto* values = std::get_if<std::vector<std::int64_t>>(other))
    return {values->begin(), values->end()};
  bad_input("{}: array {}: found vectors, expected numbers", path.string(), name);
}

std::vector<std::int64_t> integers(const PolyTable& table, bool of_points, const std::string& name,
                                   const fs::path& path) {
  if (const auto* values = find_array<std::vector<std::int64_t>>(table, of_points, name, path))
    return *values;
  bad_input("{}: array {}: found another kind, expected integers", path.string(), name);
}

std::vector<Vec3> vectors(const PolyTable& table, bool of_points, const std::string& name,
                          const fs::path& path) {
  if (const auto* values = find_array<std::vector<Vec3>>(table, of_points, name, path)) return *values;
  bad_input("{}: array {}: found another kind, expected vectors", path.string(), name);
}

}  // namespace pendular
