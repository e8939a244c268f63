#include <blosc.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <nlohmann/json.hpp>

#include "read_error.h"
#include "scratch.h"

namespace pendular::segmentation {
namespace {

using nlohmann::json;
using test::error_of;
using test::ScratchFolder;

constexpr std::array<std::size_t, 3> kSize = {7, 6, 5}, kChunk = {4, 3, 2};  // x, y, z
const ReadOptions kMicron{.spacing = 1e-6, .raw_size = {}, .raw_type = {}};

double grey(std::size_t x, std::size_t y, std::size_t z) {
  return static_cast<double>(300 + x + 10 * y + 100 * z);
}

template <typename T>
std::string bytes_of(double value, bool big_endian) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(value));
  std::string text(bytes.begin(), bytes.end());
  return big_endian ? std::string(text.rbegin(), text.rend()) : text;
}

std::string number(const std::string& dtype, double value) {
  const bool big = dtype[0] == '>';
  const std::string kind = dtype.substr(1);
  if (kind == "u2") return bytes_of<std::uint16_t>(value, big);
  if (kind == "u4") return bytes_of<std::uint32_t>(value, big);
  if (kind == "i2") return bytes_of<std::int16_t>(value, big);
  if (kind == "i8") return bytes_of<std::int64_t>(value, big);
  if (kind == "f4") return bytes_of<float>(value, big);
  return bytes_of<double>(value, big);
}

std::string compressed(const json& compressor, const std::string& bytes, std::size_t width) {
  if (compressor.is_null()) return bytes;
  if (compressor["id"] == "blosc") {
    std::string out(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
    const std::string name = compressor.value("cname", "lz4");
    out.resize(static_cast<std::size_t>(blosc_compress_ctx(
        5, BLOSC_SHUFFLE, width, bytes.size(), bytes.data(), out.data(), out.size(), name.c_str(), 0, 1)));
    return out;
  }
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  out.resize(size);
  return out;
}

/// An array as zarr-python writes it: chunks at the ends are filled up.
void write_array(const fs::path& folder, const std::string& dtype, const json& compressor,
                 const std::string& separator, std::size_t leading = 0) {
  std::vector<std::size_t> shape(leading, 1), chunks(leading, 1);
  for (const std::size_t axis : {2u, 1u, 0u}) shape.push_back(kSize[axis]), chunks.push_back(kChunk[axis]);
  fs::create_directories(folder);
  write_text(folder / ".zarray", json{{"zarr_format", 2},
                                      {"shape", shape},
                                      {"chunks", chunks},
                                      {"dtype", dtype},
                                      {"compressor", compressor},
                                      {"fill_value", 0},
                                      {"order", "C"},
                                      {"filters", nullptr},
                                      {"dimension_separator", separator}}
                                     .dump());
  const std::size_t width = static_cast<std::size_t>(dtype[2] - '0');
  for (std::size_t cz = 0; cz * kChunk[2] < kSize[2]; ++cz)
    for (std::size_t cy = 0; cy * kChunk[1] < kSize[1]; ++cy)
      for (std::size_t cx = 0; cx * kChunk[0] < kSize[0]; ++cx) {
        std::string bytes;
        for (std::size_t z = 0; z < kChunk[2]; ++z)
          for (std::size_t y = 0; y < kChunk[1]; ++y)
            for (std::size_t x = 0; x < kChunk[0]; ++x) {
              const std::array<std::size_t, 3> at{cx * kChunk[0] + x, cy * kChunk[1] + y, cz * kChunk[2] + z};
              const bool inside = at[0] < kSize[0] && at[1] < kSize[1] && at[2] < kSize[2];
              bytes += number(dtype, inside ? grey(at[0], at[1], at[2]) : 0.0);
            }
        std::string name;
        for (std::size_t k = 0; k < leading; ++k) name += "0" + separator;
        const fs::path file = folder / (name + fmt::format("{}{}{}{}{}", cz, separator, cy, separator, cx));
        fs::create_directories(file.parent_path());
        write_text(file, compressed(compressor, bytes, width));
      }
}

void expect_ramp(const Volume& volume) {
  ASSERT_EQ(volume.size, kSize);
  with_pixels(volume, [](auto pixels) {
    std::size_t n = 0;
    for (std::size_t z = 0; z < kSize[2]; ++z)
      for (std::size_t y = 0; y < kSize[1]; ++y)
        for (std::size_t x = 0; x < kSize[0]; ++x) EXPECT_EQ(static_cast<double>(pixels[n++]), grey(x, y, z));
  });
}

const json kBlosc = {{"id", "blosc"}, {"cname", "zstd"}, {"clevel", 5}, {"shuffle", 1}};
const json kZlib = {{"id", "zlib"}, {"level", 5}};

TEST(Zarr, AnArrayComesBackInEveryTypeAndCodec) {
  const ScratchFolder scratch;
  for (const auto& [dtype, kind] :
       {std::pair{"<u2", "uint16"}, std::pair{">u2", "uint16"}, std::pair{"<u4", "uint32"},
        std::pair{"<i2", "float"}, std::pair{"<f4", "float"}, std::pair{">f8", "float"},
        std::pair{"<i8", "float"}})
    for (const json& codec : {json(nullptr), kZlib, kBlosc, json{{"id", "blosc"}, {"cname", "lz4"}}})
      for (const char* separator : {".", "/"}) {
        fs::remove_all(scratch / "a");
        write_array(scratch / "a", dtype, codec, separator);
        const Volume volume = read_volume(scratch / "a", kMicron);
        EXPECT_EQ(pixel_type(volume), kind);
        expect_ramp(volume);
      }
  EXPECT_EQ(volume_files(scratch / "a").size(), 1u + 2 * 2 * 3);
}

/// Two levels of an image, (t, c, z, y, x), voxels of 4 um.
fs::path image(const ScratchFolder& scratch, const std::string& unit = "micrometer") {
  const fs::path folder = scratch / "scan.zarr";
  write_array(folder / "0", "<u2", kBlosc, "/", 2);
  write_text(folder / ".zgroup", R"({"zarr_format": 2})");
  json axes = json::array({{{"name", "t"}, {"type", "time"}}, {{"name", "c"}, {"type", "channel"}}});
  for (const char* name : {"z", "y", "x"})
    axes.push_back({{"name", name}, {"type", "space"}, {"unit", unit}});
  const json steps = json::array({{{"type", "scale"}, {"scale", {1, 1, 4.0, 4.0, 4.0}}},
                                  {{"type", "translation"}, {"translation", {0, 0, 1.0, 2.0, 3.0}}}});
  const json levels = json::array({{{"path", "0"}, {"coordinateTransformations", steps}}, {{"path", "1"}}});
  write_text(folder / ".zattrs",
             json{{"multiscales", json::array({{{"version", "0.4"}, {"axes", axes}, {"datasets", levels}}})}}
                 .dump());
  return folder;
}

TEST(Zarr, AnOmeImageIsReadAtItsLargestLevelWithItsScale) {
  const ScratchFolder scratch;
  const fs::path folder = image(scratch);
  for (const fs::path& path : {folder, folder / "0", fs::path((folder / "0").string() + "/")}) {
    const Volume volume = read_volume(path);
    EXPECT_NEAR(volume.spacing, 4e-6, 1e-18);
    EXPECT_NEAR((volume.origin - Vec3(3e-6, 2e-6, 1e-6)).norm(), 0.0, 1e-15);
    expect_ramp(volume);
  }
}

TEST(Zarr, WhatIsWrongIsSaidInOneLine) {
  const ScratchFolder scratch;
  const auto expect = [&](const fs::path& path, const std::string& part) {
    const std::string error = error_of(path, kMicron);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  };
  const auto with = [&](const char* key, const json& value) {
    fs::remove_all(scratch / "a");
    write_array(scratch / "a", "<u2", kZlib, ".");
    json head = json::parse(read_text(scratch / "a" / ".zarray"));
    head[key] = value;
    write_text(scratch / "a" / ".zarray", head.dump());
    return scratch / "a";
  };
  expect(with("dtype", "<c8"), "dtype: found <c8");
  expect(with("shape", {5, 6}), "expected three dimensions");
  expect(with("shape", {2, 5, 6, 7}), "expected three dimensions");
  expect(with("shape", {5, 6, -7}), "shape: found -7");
  expect(with("shape", {5, 6, 4294967296}), "no such chunk");
  expect(with("chunks", {4294967296, 4294967296, 4294967296}), "chunks: found");
  expect(with("order", "F"), "order: found \"F\"");
  expect(with("compressor", {{"id", "zstd"}}), "compressor: found \"zstd\"");
  expect(with("filters", json::array({{{"id", "delta"}}})), "filters: found");
  expect(with("zarr_format", 3), "zarr_format: found 3");
  expect(with("chunks", {2, 3, 5}), "bytes in a chunk, expected 60");

  with("order", "C");
  fs::remove(scratch / "a" / "1.1.0");
  expect(scratch / "a", "1.1.0: found no such chunk, expected every chunk of the array");
  for (const json& codec : {json(nullptr), kZlib, kBlosc}) {
    fs::remove_all(scratch / "b");
    write_array(scratch / "b", "<u2", codec, ".");
    const std::string chunk = read_text(scratch / "b" / "0.1.0");
    write_text(scratch / "b" / "0.1.0", chunk.substr(0, chunk.size() - 5));
    expect(scratch / "b", "0.1.0: found");
  }
  write_text(scratch / "a" / ".zarray", "{");
  expect(scratch / "a", ".zarray: found no JSON object");
  fs::create_directories(scratch / "empty.zarr");
  expect(scratch / "empty.zarr", "found neither .zarray nor multiscales");
  write_text(scratch / "empty.zarr" / "zarr.json", "{}");
  expect(scratch / "empty.zarr", "found Zarr format 3, expected format 2");
}

TEST(Zarr, AnImageCannotLeadOutOfItsFolder) {
  const ScratchFolder scratch;
  const fs::path folder = image(scratch);
  json head = json::parse(read_text(folder / ".zattrs"));
  for (const char* path : {"../a", "/a", ""}) {
    head["multiscales"][0]["datasets"][0]["path"] = path;
    write_text(folder / ".zattrs", head.dump());
    EXPECT_NE(error_of(folder).find("expected a folder of the image"), std::string::npos);
  }
}

}  // namespace
}  // namespace pendular::segmentation
