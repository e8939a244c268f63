#include "volume/zarr_array.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/path_kind.h"
#include "volume/length_unit.h"
#include "volume/read_zarr.h"

namespace pendular {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestAxis = std::size_t{1} << 32;

json read_json(const fs::path& file) {
  json found = json::parse(read_text(file), nullptr, false);
  if (!found.is_object()) bad_input("{}: found no JSON object, expected Zarr metadata", file.string());
  return found;
}

std::vector<std::size_t> lengths(const json& array, const char* key, const fs::path& file) {
  if (!array.contains(key) || !array[key].is_array())
    bad_input("{}: {}: found none, expected a list of lengths", file.string(), key);
  std::vector<std::size_t> values;
  for (const auto& value : array[key]) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() < 1 ||
        value.get<std::uint64_t>() > kLongestAxis)
      bad_input("{}: {}: found {}, expected whole numbers from 1 to {}", file.string(), key, value.dump(),
                kLongestAxis);
    values.push_back(value.get<std::size_t>());
  }
  return values;
}

void read_shape(const json& array, const fs::path& file, ZarrArray& zarr) {
  const auto shape = lengths(array, "shape", file), chunks = lengths(array, "chunks", file);
  while (shape.size() - zarr.leading > 3 && shape[zarr.leading] == 1) ++zarr.leading;
  if (shape.size() - zarr.leading != 3 || chunks.size() != shape.size())
    bad_input("{}: found shape ({}) in chunks of ({}), expected three dimensions: z, y, x", file.string(),
              fmt::join(shape, ", "), fmt::join(chunks, ", "));
  for (std::size_t k = 0; k < zarr.leading; ++k) zarr.chunk_leading *= chunks[k];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    zarr.size[axis] = shape[shape.size() - 1 - axis];
    zarr.chunk[axis] = chunks[shape.size() - 1 - axis];
  }
  double bytes = static_cast<double>(zarr.chunk_leading) * static_cast<double>(width_of(zarr.type));
  for (const std::size_t n : zarr.chunk) bytes *= static_cast<double>(n);
  constexpr double most = 2147483647.0;  // what a codec takes
  if (bytes > most)
    bad_input("{}: chunks: found {:.0f} bytes in one, expected at most {:.0f}", file.string(), bytes, most);
}

void read_type(const json& array, const fs::path& file, ZarrArray& zarr) {
  const json type = array.value("dtype", json());
  const std::string word = type.is_string() ? type.get<std::string>() : type.dump();
  static const std::map<std::string, Stored> known = {
      {"u1", Stored::uint8},   {"u2", Stored::uint16}, {"u4", Stored::uint32}, {"u8", Stored::uint64},
      {"i1", Stored::int8},    {"i2", Stored::int16},  {"i4", Stored::int32},  {"i8", Stored::int64},
      {"f4", Stored::float32}, {"f8", Stored::float64}};
  const auto found = word.size() == 3 && std::string("<>|").find(word[0]) != std::string::npos
                         ? known.find(word.substr(1))
                         : known.end();
  if (found == known.end())
    bad_input("{}: dtype: found {}, expected u1, u2, u4, u8, i1, i2, i4, i8, f4 or f8", file.string(), word);
  zarr.type = found->second;
  zarr.big_endian = word[0] == '>';
}

void read_codec(const json& array, const fs::path& file, ZarrArray& zarr) {
  if (const json order = array.value("order", json("C")); order != "C")
    bad_input("{}: order: found {}, expected C", file.string(), order.dump());
  if (const json filters = array.value("filters", json()); !filters.is_null() && !filters.empty())
    bad_input("{}: filters: found {}, expected none", file.string(), filters.dump());
  const json separator = array.value("dimension_separator", json("."));
  if (separator != "." && separator != "/")
    bad_input("{}: dimension_separator: found {}, expected \".\" or \"/\"", file.string(), separator.dump());
  zarr.separator = separator.get<std::string>()[0];
  const json compressor = array.value("compressor", json());
  if (compressor.is_null()) return;
  const json id = compressor.is_object() ? compressor.value("id", json()) : compressor;
  if (id == "blosc")
    zarr.codec = ZarrArray::Codec::blosc;
  else if (id == "zlib" || id == "gzip")
    zarr.codec = ZarrArray::Codec::deflate;
  else
    bad_input("{}: compressor: found {}, expected blosc, zlib, gzip or none", file.string(), id.dump());
}

/// The image's only or first multiscale entry; null where the folder is none.
json multiscale(const fs::path& folder) {
  const fs::path file = folder / ".zattrs";
  if (!is_file(file)) return nullptr;
  const json attributes = read_json(file);
  if (!attributes.contains("multiscales")) return nullptr;
  const json& all = attributes["multiscales"];
  if (!all.is_array() || all.empty() || !all[0].is_object() || !all[0].value("datasets", json()).is_array() ||
      all[0]["datasets"].empty())
    bad_input("{}: multiscales: found no datasets, expected at least one", file.string());
  return all[0];
}

/// Multiplies by, or adds, what the entry's transformations say of the last three axes.
void transform(const json& entry, const std::string& where, std::array<double, 3>& scale,
               std::array<double, 3>& shift) {
  for (const auto& step : entry.value("coordinateTransformations", json::array())) {
    for (const char* kind : {"scale", "translation"}) {
      if (!step.is_object() || step.value("type", json()) != kind) continue;
      const json values = step.value(kind, json());
      if (!values.is_array() || values.size() < 3)
        bad_input("{}: {}: found {}, expected a number per axis", where, kind, values.dump());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const json& value = values[values.size() - 1 - axis];
        if (!value.is_number()) bad_input("{}: {}: found {}, expected numbers", where, kind, value.dump());
        if (std::string(kind) == "scale")
          scale[axis] *= value.get<double>(), shift[axis] *= value.get<double>();
        else
          shift[axis] += value.get<double>();
      }
    }
  }
}

/// Where the voxels of a dataset of a multiscale entry are; nothing where its axes have no unit of length.
std::optional<Placement> placement_of(const json& image, const std::string& path, const fs::path& file) {
  const std::string where = file.string() + ": multiscales";
  std::array<double, 3> unit{}, scale{1.0, 1.0, 1.0}, shift{};
  const json axes = image.value("axes", json());
  if (!axes.is_array() || axes.size() < 3) return std::nullopt;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const json& one = axes[axes.size() - 1 - axis];
    const json name = one.is_object() ? one.value("name", json()) : one;
    if (name != std::string(1, "xyz"[axis]))
      bad_input("{}: axes: found {}, expected z, y, x at the end", where, axes.dump());
    const json word = one.is_object() ? one.value("unit", json()) : json();
    unit[axis] = word.is_string() ? length_unit(word.get<std::string>()) : 0.0;
  }
  for (const auto& dataset : image["datasets"])
    if (dataset.is_object() && dataset.value("path", json()) == path) transform(dataset, where, scale, shift);
  transform(image, where, scale, shift);
  Placement place;
  place.unit = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (unit[axis] == 0.0) return std::nullopt;
    if (!(scale[axis] > 0.0) || !std::isfinite(scale[axis]) || !std::isfinite(shift[axis]))
      bad_input("{}: scale: found {}, expected a positive number", where, scale[axis]);
    place.spacing[axis] = scale[axis] * unit[axis];
    place.origin[axis] = shift[axis] * unit[axis];
  }
  return place;
}

/// The image's first dataset, the largest; a name within the image.
std::string first_dataset(const json& image, const fs::path& file) {
  const json& first = image["datasets"][0];
  const json path = first.is_object() ? first.value("path", json()) : json();
  const fs::path name = path.is_string() ? path.get<std::string>() : "";
  if (name.empty() || name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
    bad_input("{}: multiscales: found path {}, expected a folder of the image", file.string(), path.dump());
  return name.string();
}

}  // namespace

fs::path ZarrArray::chunk_file(const std::array<std::size_t, 3>& at) const {
  std::string name;
  for (std::size_t k = 0; k < leading; ++k) name += std::string("0") + separator;
  return folder / fmt::format("{}{}{}{}{}{}", name, at[2], separator, at[1], separator, at[0]);
}

bool is_zarr(const fs::path& folder) {
  for (const char* name : {".zarray", ".zgroup", "zarr.json"})
    if (is_file(folder / name)) return true;
  return is_folder(folder) && folder.extension() == ".zarr";
}

ZarrArray read_zarr_metadata(const fs::path& folder) {
  if (is_file(folder / "zarr.json")) bad_input("{}: found Zarr format 3, expected format 2", folder.string());
  ZarrArray zarr;
  zarr.folder = folder;
  fs::path image_folder = folder;
  if (!is_file(folder / ".zarray")) {
    const json image = multiscale(folder);
    if (image.is_null())
      bad_input(
          "{}: found neither .zarray nor multiscales in .zattrs, expected a Zarr array or an OME-Zarr image",
          folder.string());
    zarr.folder = folder / first_dataset(image, folder / ".zattrs");
  } else {
    image_folder = fs::absolute(folder).lexically_normal().parent_path();
    if (!fs::absolute(folder).lexically_normal().has_filename()) image_folder = image_folder.parent_path();
  }
  const fs::path file = zarr.folder / ".zarray";
  const json array = read_json(file);
  if (array.value("zarr_format", json()) != 2)
    bad_input("{}: zarr_format: found {}, expected 2", file.string(),
              array.value("zarr_format", json()).dump());
  read_type(array, file, zarr);
  read_shape(array, file, zarr);
  read_codec(array, file, zarr);
  zarr.metadata = {file};
  if (const json image = multiscale(image_folder); !image.is_null()) {
    zarr.metadata.push_back(image_folder / ".zattrs");
    const fs::path within = fs::absolute(zarr.folder)
                                .lexically_normal()
                                .lexically_relative(fs::absolute(image_folder).lexically_normal());
    std::string name = within.generic_string();
    if (!name.empty() && name.back() == '/') name.pop_back();
    zarr.place = placement_of(image, name, image_folder / ".zattrs");
  }
  return zarr;
}

}  // namespace pendular
