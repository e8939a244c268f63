#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "volume/format.h"
#include "volume/header_text.h"
#include "volume/voxel_header.h"

namespace pendular {
namespace {

constexpr const char* kData = "ElementDataFile";
constexpr std::int64_t kMostDimensions = 10;

/// The fields up to ElementDataFile, which is the last.
HeaderFields fields_in(HeaderText& text) {
  HeaderFields fields(text.path());
  for (std::string line; !fields.has(kData) && text.next(line);) {
    const auto equals = line.find('=');
    if (equals == std::string::npos && trimmed(line).empty()) continue;
    if (equals == std::string::npos)
      bad_input("{}: found no image of the kind its name says (a line without '='), expected a MetaImage",
                text.path().string());
    fields.add({std::string(trimmed(std::string_view(line).substr(0, equals))),
                std::string(trimmed(std::string_view(line).substr(equals + 1)))});
  }
  return fields;
}

bool is_set(const HeaderFields& fields, const char* key, bool otherwise = false) {
  const std::string word = fields.text(key, otherwise ? "True" : "False");
  if (word == "True" || word == "true" || word == "1") return true;
  if (word == "False" || word == "false" || word == "0") return false;
  bad_input("{}: found \"{}\", expected True or False", fields.where(key), word);
}

Stored type_named(const HeaderFields& fields) {
  std::string type = fields.text("ElementType");
  const bool named = type.starts_with("MET_");
  if (named) type.erase(0, 4);
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  if (named)
    if (const auto stored = stored_named(type)) return *stored;
  bad_input("{}: found pixel type {}, expected {}", fields.where("ElementType"), type, kStoredTypes);
}

bool is_local(const std::string& name) {
  return name == "LOCAL" || name == "Local" || name == "local";
}

/// The names of a LIST, of a pattern with its numbers, or the one name that there is.
std::vector<std::string> data_names(HeaderText& text, const HeaderFields& fields, std::size_t slices) {
  const std::string& value = fields.text(kData);
  const std::string where = fields.where(kData);
  const auto words = words_of(value);
  if (words.empty()) bad_input("{}: found no name, expected a file", where);
  if (words[0] == "LIST") {
    if (words.size() > 2 || (words.size() == 2 && words[1] != "2"))
      bad_input("{}: found \"{}\", expected LIST, of slices", where, value);
    std::vector<std::string> names;
    for (std::string line; text.next(line) && names.size() <= slices;)
      if (const auto name = trimmed(line); !name.empty()) names.emplace_back(name);
    return names;
  }
  std::error_code error;
  if (value.find('%') == std::string::npos || fs::is_regular_file(text.path().parent_path() / value, error))
    return {value};
  if (words.size() > 4) bad_input("{}: found \"{}\", expected a pattern and three numbers", where, value);
  const auto number = [&](std::size_t k, std::int64_t otherwise) {
    return words.size() > k ? to_integer(where, words[k], 0, 1000000000) : otherwise;
  };
  const std::int64_t first = number(1, 1);
  return expanded(where, words[0], first, number(2, first + static_cast<std::int64_t>(slices) - 1),
                  number(3, 1), slices);
}

void find_data(HeaderText& text, const HeaderFields& fields, VoxelHeader& header) {
  const std::string& value = fields.text(kData);
  if (is_local(value)) {
    header.files = {text.path()};
    header.first_byte = text.position();
    return;
  }
  const auto names = data_names(text, fields, header.size[2]);
  if (names.size() != 1 && names.size() != header.size[2])
    bad_input("{}: found {} files, expected one for each of the {} slices", fields.where(kData), names.size(),
              header.size[2]);
  if (names.size() == 1 && words_of(value)[0] == "LIST" && header.size[2] != 1)
    bad_input("{}: found 1 file, expected one for each of the {} slices", fields.where(kData),
              header.size[2]);
  for (const auto& name : names) header.files.push_back(data_file(fields.where(kData), text.path(), name));
  const std::int64_t skipped = fields.integer("HeaderSize", -1, std::int64_t{1} << 60, 0);
  header.at_end = skipped < 0;
  header.first_byte = skipped < 0 ? 0 : static_cast<std::uint64_t>(skipped);
}

/// The first of these fields that is there.
const char* first_of(const HeaderFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (fields.has(key)) return key;
  return nullptr;
}

Placement place_of(const HeaderFields& fields) {
  Placement place;
  if (fields.has("ElementSpacing"))
    place.spacing = edges_of(fields.where("ElementSpacing"), fields.numbers("ElementSpacing"));
  if (const char* key = first_of(fields, {"Offset", "Position", "Origin"})) {
    const auto numbers = fields.numbers(key);
    if (numbers.size() < 3) bad_input("{}: found {} numbers, expected 3", fields.where(key), numbers.size());
    std::copy_n(numbers.begin(), 3, place.origin.begin());
  }
  return place;
}

}  // namespace

VoxelHeader read_meta_header(const fs::path& path) {
  HeaderText text(path);
  const HeaderFields fields = fields_in(text);
  if (fields.text("ObjectType", "Image") != "Image")
    bad_input("{}: found {}, expected Image", fields.where("ObjectType"), fields.text("ObjectType"));
  const std::int64_t dimensions = fields.integer("NDims", 1, kMostDimensions);
  if (dimensions < 3) bad_input("{}: found an image of {} dimensions, expected 3", path.string(), dimensions);
  if (const auto channels = fields.integer("ElementNumberOfChannels", 1, 1000, 1); channels != 1)
    bad_input("{}: found {} components per voxel, expected one (grey)", path.string(), channels);
  VoxelHeader header;
  header.type = type_named(fields);
  header.size = volume_size(fields, "DimSize", dimensions, width_of(header.type));
  header.place = place_of(fields);
  header.big_endian = is_set(fields, "BinaryDataByteOrderMSB") || is_set(fields, "ElementByteOrderMSB");
  const bool compressed = is_set(fields, "CompressedData"), binary = is_set(fields, "BinaryData", true);
  header.encoding = compressed ? VoxelHeader::Encoding::deflated
                    : binary   ? VoxelHeader::Encoding::raw
                               : VoxelHeader::Encoding::text;
  if (compressed && fields.has("CompressedDataSize"))
    header.stored =
        static_cast<std::uint64_t>(fields.integer("CompressedDataSize", 1, std::int64_t{1} << 60));
  find_data(text, fields, header);
  if (compressed && header.files.size() > 1)
    bad_input("{}: found compressed slices, expected them in one file", fields.where(kData));
  return header;
}

VolumeFormat formats::meta_image() {
  return {.name = "MetaImage (.mha, .mhd)",
          .recognises =
              [](const fs::path& path, const ReadOptions&) {
                const std::string extension = lower_extension(path);
                return extension == ".mha" || extension == ".mhd";
              },
          .files = [](const fs::path& path) { return files_of(path, read_meta_header(path)); },
          .read =
              [](const fs::path& path, const ReadOptions& options) {
                return read_with_header(read_meta_header(path), path, options);
              }};
}

}  // namespace pendular
