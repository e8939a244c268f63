#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"

namespace pendular {

/// Bytes that a byte of zlib's gives, at most.
inline constexpr std::uint64_t kDeflateLimit = 1032;

/// A DataArray element of a .vtp, as it stands there. Internal to packing, as all here.
struct XmlArray {
  enum class Format { ascii, binary, appended };

  std::string name, type;
  std::int64_t components = 1;
  std::int64_t tuples = -1;  ///< where the element says so
  Format format = Format::ascii;
  std::uint64_t offset = 0;  ///< of an appended one
  std::string text;          ///< of the others
};

/// What the XML of a PolyData file says, checked: counts and offsets are whole numbers that fit the file.
struct PolyXml {
  bool big_endian = false, wide_heads = false, deflated = false, raw_appended = false;
  std::int64_t points = 0, verts = 0, lines = 0, strips = 0, polys = 0;
  std::vector<XmlArray> fields, point_data, cell_data, coordinates, line_ends;
  std::string_view appended;  ///< of the file's bytes; empty where there is none
};

/// BadInput, opening with the path, for XML that is damaged, not of a PolyData file, has more than one piece,
/// a document type, or counts that the file cannot hold.
PolyXml read_poly_xml(const fs::path& path, std::string_view bytes);

/// The numbers of an array, or the text of one of type String. BadInput where it does not hold `tuples`, or
/// its data are damaged.
std::vector<double> doubles_in(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                               const fs::path& path);
std::vector<std::int64_t> integers_in(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                                      const fs::path& path);
std::string text_in(const PolyXml& xml, const XmlArray& array, const fs::path& path);

bool is_floating(const XmlArray& array);
bool is_text(const XmlArray& array);

}  // namespace pendular
