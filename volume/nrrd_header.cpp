#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/error.h"
#include "volume/format.h"
#include "volume/header_text.h"
#include "volume/length_unit.h"
#include "volume/voxel_header.h"

namespace pendular {
namespace {

constexpr std::int64_t kMostDimensions = 16;

/// Fields have several spellings; without blanks they agree.
std::string plain_key(std::string_view key) {
  std::string plain;
  for (const char c : key)
    if (c != ' ') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return plain;
}

/// The fields up to the first empty line; comments and "key:=value" pairs aside.
HeaderFields fields_in(HeaderText& text) {
  std::string line;
  if (!text.next(line) || !line.starts_with("NRRD000"))
    bad_input("{}: found no image of the kind its name says, expected an NRRD", text.path().string());
  HeaderFields fields(text.path());
  while (text.next(line) && !trimmed(line).empty()) {
    if (line[0] == '#') continue;
    const auto colon = line.find(':');
    if (colon == std::string::npos)
      bad_input("{}: found a line \"{}\", expected field: value", text.path().string(), line.substr(0, 80));
    if (line.substr(colon, 2) == ":=") continue;
    const std::string key = plain_key(std::string_view(line).substr(0, colon));
    fields.add({key, std::string(trimmed(std::string_view(line).substr(colon + 1)))});
    if (key == "datafile" && fields.text(key).starts_with("LIST")) break;  // names follow
  }
  return fields;
}

Stored type_named(const HeaderFields& fields) {
  const std::string& type = fields.text("type");
  if (const auto stored = stored_named(type)) return *stored;
  bad_input("{}: found pixel type \"{}\", expected {}", fields.where("type"), type, kStoredTypes);
}

VoxelHeader::Encoding encoding_of(const HeaderFields& fields) {
  const std::string& word = fields.text("encoding");
  if (word == "raw") return VoxelHeader::Encoding::raw;
  if (word == "gzip" || word == "gz") return VoxelHeader::Encoding::deflated;
  if (word == "text" || word == "txt" || word == "ascii") return VoxelHeader::Encoding::text;
  bad_input("{}: found \"{}\", expected raw, gzip or text", fields.where("encoding"), word);
}

bool is_big_endian(const HeaderFields& fields, std::size_t bytes_per_voxel, VoxelHeader::Encoding encoding) {
  if (bytes_per_voxel == 1 || encoding == VoxelHeader::Encoding::text) return false;
  const std::string& word = fields.text("endian");
  if (word != "little" && word != "big")
    bad_input("{}: found \"{}\", expected little or big", fields.where("endian"), word);
  return word == "big";
}

/// The length of the header's unit, m; µm where it names none.
double unit_of(const HeaderFields& fields) {
  const std::string key = fields.has("spaceunits") ? "spaceunits" : "units";
  if (!fields.has(key)) return 1e-6;
  const std::string& text = fields.text(key);
  const auto first = text.find('"'), last = text.find('"', first + 1);
  const std::string unit = last == std::string::npos ? "" : text.substr(first + 1, last - first - 1);
  const double metres = length_unit(unit);
  if (metres == 0.0)
    bad_input("{}: found no known length unit, expected \"m\", \"cm\", \"mm\", \"um\" or \"nm\"",
              fields.where(key));
  return metres;
}

/// "(a,b,c) (d,e,f) …" as vectors; "none" for an axis without one is left out.
std::vector<std::array<double, 3>> vectors_in(const HeaderFields& fields, std::string_view key) {
  const std::string where = fields.where(key), &text = fields.text(key);
  std::vector<std::array<double, 3>> vectors;
  for (std::size_t open = text.find('('); open != std::string::npos; open = text.find('(', open + 1)) {
    const std::size_t close = text.find(')', open);
    std::string inner = text.substr(open + 1, close == std::string::npos ? close : close - open - 1);
    std::replace(inner.begin(), inner.end(), ',', ' ');
    const auto words = words_of(inner);
    if (close == std::string::npos || words.size() != 3)
      bad_input("{}: found \"{}\", expected vectors as (1,0,0)", where, text);
    vectors.push_back({to_number(where, words[0]), to_number(where, words[1]), to_number(where, words[2])});
  }
  return vectors;
}

Placement place_of(const HeaderFields& fields) {
  Placement place;
  place.unit = unit_of(fields);
  if (fields.has("spacings")) {
    place.spacing = edges_of(fields.where("spacings"), fields.numbers("spacings"));
  } else if (fields.has("spacedirections")) {
    std::vector<double> lengths;
    for (const auto& v : vectors_in(fields, "spacedirections"))
      lengths.push_back(std::hypot(v[0], v[1], v[2]));
    place.spacing = edges_of(fields.where("spacedirections"), lengths);
  }
  if (!fields.has("spaceorigin")) return place;
  const auto origin = vectors_in(fields, "spaceorigin");
  if (origin.size() != 1) bad_input("{}: expected one vector", fields.where("spaceorigin"));
  place.origin = origin[0];
  // Axes to the right and to the front are turned to the left and to the back, as other readers do.
  const std::string space = plain_key(fields.text("space", ""));
  const bool right = space == "right-anterior-superior" || space == "ras";
  const bool front = right || space == "left-anterior-superior" || space == "las";
  if (right) place.origin[0] = -place.origin[0];
  if (front) place.origin[1] = -place.origin[1];
  return place;
}

std::vector<std::string> data_names(HeaderText& text, const HeaderFields& fields, std::size_t slices) {
  const std::string& value = fields.text("datafile");
  const std::string where = fields.where("datafile");
  const auto words = words_of(value);
  const auto check_slices = [&](std::size_t at) {
    if (words.size() > at + 1 || (words.size() == at + 1 && words[at] != "2"))
      bad_input("{}: found \"{}\", expected slices of 2 dimensions", where, value);
  };
  if (words.empty()) bad_input("{}: found no name, expected a file", where);
  if (words[0] == "LIST") {
    check_slices(1);
    std::vector<std::string> names;
    for (std::string line; text.next(line) && names.size() <= slices;)
      if (const auto name = trimmed(line); !name.empty()) names.emplace_back(name);
    return names;
  }
  if (words[0].find('%') == std::string::npos || words.size() < 4) return {value};
  check_slices(4);
  const auto number = [&](std::size_t k) { return to_integer(where, words[k], 0, 1000000000); };
  return expanded(where, words[0], number(1), number(2), number(3), slices);
}

void find_data(HeaderText& text, const HeaderFields& fields, VoxelHeader& header) {
  const bool deflated = header.encoding == VoxelHeader::Encoding::deflated;
  if (fields.integer("lineskip", 0, std::int64_t{1} << 60, 0) != 0)
    bad_input("{}: found lines to skip, expected none", fields.where("lineskip"));
  const std::int64_t skipped = fields.integer("byteskip", -1, std::int64_t{1} << 60, 0);
  if (skipped != 0 && header.encoding != VoxelHeader::Encoding::raw)
    bad_input("{}: found {}, expected 0 for data that are not raw", fields.where("byteskip"), skipped);
  if (!fields.has("datafile")) {
    header.files = {text.path()};
    header.at_end = skipped < 0;
    header.first_byte = skipped < 0 ? 0 : text.position() + static_cast<std::uint64_t>(skipped);
    return;
  }
  const auto names = data_names(text, fields, header.size[2]);
  const bool list = words_of(fields.text("datafile"))[0] == "LIST";
  if ((list || names.size() != 1) && names.size() != header.size[2])
    bad_input("{}: found {} files, expected one for each of the {} slices", fields.where("datafile"),
              names.size(), header.size[2]);
  if (deflated && names.size() > 1)
    bad_input("{}: found compressed slices, expected them in one file", fields.where("datafile"));
  for (const auto& name : names)
    header.files.push_back(data_file(fields.where("datafile"), text.path(), name));
  header.at_end = skipped < 0;
  header.first_byte = skipped < 0 ? 0 : static_cast<std::uint64_t>(skipped);
}

}  // namespace

VoxelHeader read_nrrd_header(const fs::path& path) {
  HeaderText text(path);
  const HeaderFields fields = fields_in(text);
  VoxelHeader header;
  header.type = type_named(fields);
  const std::int64_t dimensions = fields.integer("dimension", 1, kMostDimensions);
  if (dimensions < 3) bad_input("{}: found an image of {} dimensions, expected 3", path.string(), dimensions);
  const std::size_t bytes = width_of(header.type);
  header.size = volume_size(fields, "sizes", dimensions, bytes);
  header.encoding = encoding_of(fields);
  header.big_endian = is_big_endian(fields, bytes, header.encoding);
  header.place = place_of(fields);
  find_data(text, fields, header);
  return header;
}

VolumeFormat formats::nrrd() {
  return {.name = "NRRD (.nrrd, .nhdr)",
          .recognises =
              [](const fs::path& path, const ReadOptions&) {
                const std::string extension = lower_extension(path);
                return extension == ".nrrd" || extension == ".nhdr";
              },
          .files = [](const fs::path& path) { return files_of(path, read_nrrd_header(path)); },
          .read =
              [](const fs::path& path, const ReadOptions& options) {
                return read_with_header(read_nrrd_header(path), path, options);
              }};
}

}  // namespace pendular
