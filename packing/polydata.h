#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/files.h"
#include "base/vec3.h"

namespace pendular {

/// Points, lines and named arrays, as VTK PolyData files (.vtp) hold them; a plain value so that no other
/// folder needs VTK to read or write one. Units belong to the arrays' names; coordinates are in µm.
struct PolyTable {
  using Array = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<Vec3>>;

  std::vector<Vec3> points;
  std::vector<std::array<int, 2>> lines;                  ///< pairs of point indices
  std::vector<std::pair<std::string, Array>> point_data;  ///< each as long as points, written in this order
  std::vector<std::pair<std::string, Array>> line_data;   ///< each as long as lines
  std::map<std::string, std::string> text_fields;  ///< field data: units, format version, provenance …
  std::map<std::string, double> number_fields;     ///< field data: specimen_height_um, strain …
};

/// Writes a .vtp whole or not at all (XML, appended and compressed); equal tables give equal bytes.
void write_polydata(const fs::path& path, const PolyTable& table);

/// Writes a VTKHDF file (UnstructuredGrid, version 1.0, as VTK 9.1 and ParaView 5.10 read it), whole or not
/// at all: the lines are its cells, or the points where there are no lines. Equal tables give equal bytes.
void write_vtkhdf(const fs::path& path, const PolyTable& table);

/// Reads a .vtp of one piece: ASCII, base64 or raw, uncompressed or by zlib. VTK sees no byte of it. BadInput
/// where the file is no readable .vtp, is truncated, or an array has another length than it must.
PolyTable read_polydata(const fs::path& path);

/// A named array of the wanted type (integers are converted to numbers); BadInput naming file and array
/// where it is missing or of another kind.
std::vector<double> numbers(const PolyTable& table, bool of_points, const std::string& name,
                            const fs::path& path);
std::vector<std::int64_t> integers(const PolyTable& table, bool of_points, const std::string& name,
                                   const fs::path& path);
std::vector<Vec3> vectors(const PolyTable& table, bool of_points, const std::string& name,
                          const fs::path& path);

}  // namespace pendular
