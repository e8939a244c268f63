#include "packing/polydata.h"

#include <cstring>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/module.h"
#include "packing/polydata_files.h"
#include "packing/polydata_xml.h"

namespace pendular {
namespace {

const PolydataFiles& polydata_files() {
  static const auto* files =
      static_cast<const PolydataFiles*>(module_symbol(PENDULAR_POLYDATA, "pendular_polydata_files"));
  return *files;
}

/// Tuples [first, first + count) of an array of `tuples`, of one or three components.
PolyTable::Array table_array(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                             std::int64_t first, std::int64_t count, const fs::path& path) {
  const auto part = [&](const auto& values) {
    return std::remove_cvref_t<decltype(values)>(values.begin() + first, values.begin() + first + count);
  };
  if (array.components == 1 && !is_floating(array)) return part(integers_in(xml, array, tuples, path));
  const std::vector<double> all = doubles_in(xml, array, tuples, path);
  if (array.components == 1) return part(all);
  std::vector<Vec3> vectors;
  for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(first + count); ++k)
    vectors.emplace_back(all[3 * k], all[3 * k + 1], all[3 * k + 2]);
  return vectors;
}

/// The arrays of points or cells, of which `count` from `first` on belong to the table; those of other kinds
/// aside.
std::vector<std::pair<std::string, PolyTable::Array>> table_arrays(const PolyXml& xml,
                                                                   const std::vector<XmlArray>& arrays,
                                                                   std::int64_t tuples, std::int64_t first,
                                                                   std::int64_t count, const fs::path& path) {
  std::vector<std::pair<std::string, PolyTable::Array>> found;
  for (const auto& array : arrays)
    if (!array.name.empty() && !is_text(array) && (array.components == 1 || array.components == 3))
      found.emplace_back(array.name, table_array(xml, array, tuples, first, count, path));
  return found;
}

std::vector<Vec3> points_of(const PolyXml& xml, const fs::path& path) {
  if (xml.points == 0) return {};
  if (xml.coordinates.size() != 1 || xml.coordinates[0].components != 3)
    bad_input("{}: Points: expected one array of 3 components", path.string());
  return std::get<std::vector<Vec3>>(table_array(xml, xml.coordinates[0], xml.points, 0, xml.points, path));
}

const XmlArray& line_array(const PolyXml& xml, const std::string& name, const fs::path& path) {
  for (const auto& array : xml.line_ends)
    if (array.name == name) return array;
  bad_input("{}: Lines: array {} is missing", path.string(), name);
}

std::vector<std::array<int, 2>> lines_of(const PolyXml& xml, const fs::path& path) {
  std::vector<std::array<int, 2>> lines;
  if (xml.lines == 0) return lines;
  const auto ends = integers_in(xml, line_array(xml, "offsets", path), xml.lines, path);
  for (std::int64_t k = 0; k < xml.lines; ++k) {
    const std::int64_t before = k == 0 ? 0 : ends[static_cast<std::size_t>(k) - 1];
    if (ends[static_cast<std::size_t>(k)] - before != 2)
      bad_input("{}: line {}: found {} points, expected 2", path.string(), k,
                ends[static_cast<std::size_t>(k)] - before);
  }
  const auto points = integers_in(xml, line_array(xml, "connectivity", path), 2 * xml.lines, path);
  for (std::size_t k = 0; k < points.size(); k += 2) {
    for (const std::int64_t point : {points[k], points[k + 1]})
      if (point < 0 || point >= xml.points)
        bad_input("{}: line {}: found point {}, expected one of {} points", path.string(), k / 2, point,
                  xml.points);
    lines.push_back({static_cast<int>(points[k]), static_cast<int>(points[k + 1])});
  }
  return lines;
}

void read_fields(const PolyXml& xml, PolyTable& table, const fs::path& path) {
  for (const auto& array : xml.fields) {
    if (array.name.empty() || array.components != 1 || (array.tuples != 1 && array.tuples != -1)) continue;
    if (is_text(array))
      table.text_fields[array.name] = text_in(xml, array, path);
    else
      table.number_fields[array.name] = doubles_in(xml, array, 1, path)[0];
  }
}

constexpr const char* kEnd = "</VTKFile>";
constexpr const char* kSeal = "<!-- pendular sha256 ";

/// The comment that closes the files written here, so that damage is noticed.
std::string seal(std::string_view content) {
  return kSeal + sha256(content) + " -->\n";
}

/// The bytes of a file that is whole and, if it was written here, undamaged.
std::string whole_file(const fs::path& path) {
  std::string bytes = read_text(path);
  const std::size_t end = bytes.rfind(kEnd);
  if (end == std::string::npos)
    bad_input("{}: found no {} at its end, expected a whole VTK XML file (.vtp)", path.string(), kEnd);
  const std::size_t sealed = bytes.rfind(kSeal);
  if (sealed == std::string::npos &&
      bytes.find_first_not_of(" \r\n\t", end + std::strlen(kEnd)) == std::string::npos)
    return bytes;  // of another program
  if (sealed == std::string::npos || bytes.substr(sealed) != seal(std::string_view(bytes).substr(0, sealed)))
    bad_input("{}: found damaged VTK data (its checksum does not match), expected the file as it was written",
              path.string());
  return bytes;
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
  write_atomically(path, [&](const fs::path& temporary) {
    if (!polydata_files().write(temporary, table))
      throw ComputationFailed(fmt::format("{}: cannot be written (folder or disc full?)", path.string()));
    std::ofstream out(temporary, std::ios::binary | std::ios::app);
    out << seal(read_text(temporary));
    out.close();
    if (!out) throw ComputationFailed(fmt::format("{}: cannot be written (disc full?)", path.string()));
  });
}

void write_vtkhdf(const fs::path& path, const PolyTable& table) {
  write_atomically(path, [&](const fs::path& temporary) {
    if (!polydata_files().write_vtkhdf(temporary, table))
      throw ComputationFailed(fmt::format("{}: cannot be written (folder or disc full?)", path.string()));
  });
}

PolyTable read_polydata(const fs::path& path) {
  const std::string bytes = whole_file(path);
  const PolyXml xml = read_poly_xml(path, bytes);
  if (xml.points > std::numeric_limits<int>::max())
    bad_input("{}: found {} points, expected fewer", path.string(), xml.points);
  const std::int64_t cells = xml.verts + xml.lines + xml.strips + xml.polys;
  PolyTable table;
  table.points = points_of(xml, path);
  table.lines = lines_of(xml, path);
  table.point_data = table_arrays(xml, xml.point_data, xml.points, 0, xml.points, path);
  table.line_data = table_arrays(xml, xml.cell_data, cells, xml.verts, xml.lines, path);
  read_fields(xml, table, path);
  return table;
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
