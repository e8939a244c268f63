#include "volume/volume.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "base/own_process.h"
#include "read_error.h"
#include "scratch.h"

namespace pendular::segmentation {
namespace {

using test::error_of;
using test::ScratchFolder;

Volume ramp() {
  Volume volume{{5, 4, 3}, 2.5e-6, Vec3(1e-6, 2e-6, 3e-6), {}};
  std::vector<std::uint16_t> pixels(volume.voxels());
  for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = static_cast<std::uint16_t>(1000 + n);
  volume.pixels = pixels;
  return volume;
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string bytes_of(const Volume& volume) {
  return with_pixels(volume, [](auto pixels) {
    return std::string(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes());
  });
}

/// Whether two volumes hold the same grey values of the same type.
bool same_grey(const Volume& a, const Volume& b) {
  return pixel_type(a) == pixel_type(b) && bytes_of(a) == bytes_of(b);
}

TEST(Volume, MetaImageComesBackAsItWas) {
  const ScratchFolder folder;
  for (const Volume::Pixels& pixels :
       std::vector<Volume::Pixels>{std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8},
                                   std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6, 7, 60000},
                                   std::vector<float>{1, 2, 3, 4, 5, 6, 7, -1.5f},
                                   std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 70000}}) {
    const Volume volume{{2, 2, 2}, 2.5e-6, Vec3(1e-6, 2e-6, -3e-6), pixels};
    write_volume(folder / "a.mha", volume);
    const Volume read = read_volume(folder / "a.mha");
    EXPECT_TRUE(same_grey(read, volume));
    EXPECT_EQ(read.size, volume.size);
    EXPECT_DOUBLE_EQ(read.spacing, volume.spacing);
    EXPECT_NEAR((read.origin - volume.origin).norm(), 0.0, 1e-18);
  }
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  return out.substr(0, size);
}

/// Bytes of -3, -2, ... as numbers of this type.
template <typename T>
std::string numbers(bool big_endian) {
  std::string bytes;
  for (int k = 0; k < 60; ++k) {
    const auto number = std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(k - 3));
    bytes +=
        big_endian ? std::string(number.rbegin(), number.rend()) : std::string(number.begin(), number.end());
  }
  return bytes;
}

void expect_numbers(const Volume& volume) {
  ASSERT_EQ(pixel_type(volume), "float");
  with_pixels(volume, [](auto pixels) {
    for (std::size_t k = 0; k < pixels.size(); ++k)
      EXPECT_EQ(static_cast<double>(pixels[k]), static_cast<double>(k) - 3.0);
  });
}

TEST(Volume, NumbersWithASignAndDoubleBecomeFloat) {
  const ScratchFolder folder;
  struct Type {
    const char *meta, *nrrd, *raw;
    std::string little, big;
  };
  const auto type = [&]<typename T>(T, const char* meta, const char* nrrd, const char* raw) {
    return Type{meta, nrrd, raw, numbers<T>(false), numbers<T>(true)};
  };
  for (const Type& t : {type(std::int8_t{}, "MET_CHAR", "signed char", "int8"),
                        type(std::int16_t{}, "MET_SHORT", "short int", "int16"),
                        type(std::int32_t{}, "MET_INT", "int32", "int32"),
                        type(std::int64_t{}, "MET_LONG_LONG", "signed long long int", "int64"),
                        type(double{}, "MET_DOUBLE", "double", "double")}) {
    write_text(folder / "a.raw", t.little);
    expect_numbers(read_volume(folder / "a.raw", {3e-6, {{5, 4, 3}}, t.raw}));
    for (const bool big : {false, true}) {
      const std::string& data = big ? t.big : t.little;
      write_text(folder / "a.mha", fmt::format("NDims = 3\nDimSize = 5 4 3\nElementSpacing = 2 2 2\n"
                                               "ElementType = {}\nBinaryData = True\n"
                                               "BinaryDataByteOrderMSB = {}\nElementDataFile = LOCAL\n",
                                               t.meta, big ? "True" : "False") +
                                       data);
      expect_numbers(read_volume(folder / "a.mha"));
      const std::string nrrd =
          fmt::format("NRRD0004\ntype: {}\ndimension: 3\nsizes: 5 4 3\nspacings: 2 2 2\nendian: {}\n", t.nrrd,
                      big ? "big" : "little");
      write_text(folder / "a.nrrd", nrrd + "encoding: raw\n\n" + data);
      expect_numbers(read_volume(folder / "a.nrrd"));
      write_text(folder / "a.nrrd", nrrd + "encoding: gzip\n\n" + deflated(data));
      expect_numbers(read_volume(folder / "a.nrrd"));
    }
  }
}

TEST(Volume, TiffComesBackAsItWas) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  write_volume(folder / "a.tif", volume);
  ReadOptions options;
  options.spacing = volume.spacing;
  const Volume read = read_volume(folder / "a.tif", options);
  EXPECT_TRUE(same_grey(read, volume));
  EXPECT_EQ(read.size, volume.size);
  EXPECT_THROW(write_volume(folder / "a.png", volume), BadUsage);
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST(Volume, PlainDataStayInTheirFile) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  for (const std::string header : {"", "Comment = x\n", "Comment = xy\n"}) {  // grey values at odd places too
    write_bytes(folder / "a.mha", "NDims = 3\nBinaryData = True\nElementSpacing = 2 2 2\n" + header +
                                      "DimSize = 5 4 3\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
                                      bytes_of(volume));
    const Volume read = read_volume(folder / "a.mha");
    EXPECT_TRUE(read.file);
    EXPECT_TRUE(same_grey(read, volume));
    release(read);
    EXPECT_TRUE(same_grey(read, volume));  // read anew
  }
  std::string swapped = bytes_of(volume);
  for (std::size_t k = 0; k + 1 < swapped.size(); k += 2) std::swap(swapped[k], swapped[k + 1]);
  write_bytes(
      folder / "a.mha",
      "NDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\nElementSpacing = 2 2 2\nDimSize = 5 4 "
      "3\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
          swapped);
  const Volume read = read_volume(folder / "a.mha");
  EXPECT_FALSE(read.file);
  EXPECT_TRUE(same_grey(read, volume));
}

TEST(Volume, VoxelsThatAreNotCubicBecomeSo) {
  const ScratchFolder folder;
  const Volume volume = ramp();  // 5 x 4 x 3, grey values 1000 + 1 x + 5 y + 20 z
  write_bytes(
      folder / "a.mha",
      "NDims = 3\nBinaryData = True\nElementSpacing = 2 2 5\nOffset = 1 2 3\nDimSize = 5 4 3\nElementType = "
      "MET_USHORT\nElementDataFile = LOCAL\n" +
          bytes_of(volume));
  const Volume read = read_volume(folder / "a.mha");
  EXPECT_EQ(read.size, (std::array<std::size_t, 3>{5, 4, 6}));
  EXPECT_DOUBLE_EQ(read.spacing, 2e-6);
  EXPECT_NEAR((read.origin - 1e-6 * Vec3(1, 2, 3)).norm(), 0.0, 1e-15);
  const auto& grey = std::get<std::vector<std::uint16_t>>(read.pixels);
  for (std::size_t k = 1; k < 4; ++k)  // the ends continue, and a ramp that ends is no ramp
    EXPECT_NEAR(grey[k * 20], 1000.0 + 20.0 * static_cast<double>(k) * 2.0 / 5.0, 1.6) << k;
  EXPECT_EQ(grey[5 * 20], 1040);
  EXPECT_EQ(grey[3 * 5 + 4], 1019);
  ReadOptions options;
  options.spacing = 2e-6;
  EXPECT_EQ(read_volume(folder / "a.mha", options).size, volume.size);
}

TEST(Volume, AFileCutShortWhileInUseEndsTheProgramWithOneLine) {
  const ScratchFolder folder;
  Volume volume{{64, 64, 64}, 2e-6, Vec3::Zero(), std::vector<std::uint16_t>(64 * 64 * 64, 7)};
  std::get<std::vector<std::uint16_t>>(volume.pixels)[0] = 8;
  write_volume(folder / "a.mha", volume);
  const Volume read = read_volume(folder / "a.mha");
  fs::resize_file(folder / "a.mha", 100);
  EXPECT_EXIT((own_process(), bytes_of(read)), testing::ExitedWithCode(4),
              "^pendular: an input file was cut short.*\n$");
}

std::string pcr(const std::string& format, const std::string& voxel = "0.0025") {
  return "[ImageData]\nPCA_File=D:\\scan\\beads.pca\n[VolumeData]\nVOL_File=D:\\scan\\beads_rec.vol\n"
         "VoxelSizeRec=" +
         voxel + "\nFormat=" + format +
         "\nVolume_SizeX=5\nVolume_SizeY=4\nVolume_SizeZ=3\n[Geometry]\nVoxelSizeX=0.1\n";
}

TEST(Volume, PhoenixVolumeByEitherOfItsFiles) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  write_text(folder / "beads.pcr", pcr("5"));
  write_bytes(folder / "beads.vol", bytes_of(volume));
  for (const char* name : {"beads.pcr", "beads.vol"}) {
    const Volume read = read_volume(folder / name);
    EXPECT_TRUE(same_grey(read, volume)) << name;
    EXPECT_EQ(read.size, volume.size) << name;
    EXPECT_NEAR(read.spacing, 2.5e-6, 1e-15) << name;
  }
  // Under the name that the parameters give, whatever folder they name; with another voxel size.
  fs::rename(folder / "beads.vol", folder / "beads_rec.vol");
  ReadOptions options;
  options.spacing = 5e-6;
  EXPECT_DOUBLE_EQ(read_volume(folder / "beads.pcr", options).spacing, 5e-6);
  const std::vector<float> pixels(60, 1.5F);
  Volume floats{volume.size, 1e-6, Vec3::Zero(), pixels};
  std::get<std::vector<float>>(floats.pixels)[7] = -2.0F;
  write_text(folder / "beads.pcr", pcr("10"));
  write_bytes(folder / "beads_rec.vol", bytes_of(floats));
  EXPECT_TRUE(same_grey(read_volume(folder / "beads.pcr"), floats));
}

TEST(Volume, BadPhoenixFilesAreNamed) {
  const ScratchFolder folder;
  write_text(folder / "a.pcr", pcr("5"));
  EXPECT_NE(error_of(folder / "a.pcr").find("a.vol"), std::string::npos);  // not there
  const std::string name = "beads_rec.vol";
  const std::string part(180, 'x');  // lines end after 200 characters; an indented one goes on
  write_text(folder / "long.pcr", pcr("5").replace(pcr("5").find(name), name.size(), part + "\n " + part));
  EXPECT_NE(error_of(folder / "long.pcr").find("cannot be seen: File name too long"), std::string::npos);
  write_bytes(folder / "a.vol", "too short");
  EXPECT_NE(error_of(folder / "a.pcr").find("expected 120"), std::string::npos) << error_of(folder / "a.pcr");
  write_text(folder / "a.pcr", pcr("7"));
  EXPECT_NE(error_of(folder / "a.pcr").find("Format"), std::string::npos);
  write_text(folder / "a.pcr", pcr("5", "nan"));
  EXPECT_NE(error_of(folder / "a.pcr").find("VoxelSizeRec"), std::string::npos);
  write_text(folder / "a.pcr", "[VolumeData]\nVolume_SizeX=1e9\n");
  EXPECT_NE(error_of(folder / "a.pcr").find("Volume_SizeX"), std::string::npos);
  write_text(folder / "a.pcr", std::string(3000, '\xff'));
  EXPECT_NE(error_of(folder / "a.pcr").find("Volume_SizeX"), std::string::npos);
}

TEST(Volume, HeaderlessData) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  write_bytes(folder / "a.raw", bytes_of(volume));
  const Volume read = read_volume(folder / "a.raw", {3e-6, {{5, 4, 3}}, "uint16"});
  EXPECT_TRUE(same_grey(read, volume));
  EXPECT_EQ(read.spacing, 3e-6);
  EXPECT_NE(error_of(folder / "a.raw", {3e-6, {{5, 4, 4}}, "uint16"}).find("found 120 bytes, expected 160"),
            std::string::npos);
  EXPECT_THROW(read_volume(folder / "a.raw", {3e-6, {{5, 4, 3}}, "int7"}), BadUsage);
}

TEST(Volume, SlicesComeInTheOrderOfTheirNumbers) {
  const ScratchFolder folder;
  for (int k = 8; k < 12; ++k)
    cv::imwrite((folder / fmt::format("slice_{}.tif", k)).string(),
                cv::Mat(3, 4, CV_16UC1, cv::Scalar(100 * k)));
  const Volume volume = read_volume(folder.path(), {2e-6, {}, ""});
  EXPECT_EQ(volume.size, (std::array<std::size_t, 3>{4, 3, 4}));
  const auto& pixels = std::get<std::vector<std::uint16_t>>(volume.pixels);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(pixels[12 * k], 800 + 100 * k);

  fs::remove(folder / "slice_10.tif");
  EXPECT_NE(error_of(folder.path()).find("expected no slice missing"), std::string::npos);
  cv::imwrite((folder / "slice_10.tif").string(), cv::Mat(3, 5, CV_16UC1, cv::Scalar(1)));
  EXPECT_NE(error_of(folder.path()).find("found a slice of 5 x 3, expected 4 x 3"), std::string::npos);
  cv::imwrite((folder / "slice_10.tif").string(), cv::Mat(3, 4, CV_8UC1, cv::Scalar(1)));
  EXPECT_NE(error_of(folder.path()).find("found another pixel type"), std::string::npos);
  cv::imwrite((folder / "slice_10.tif").string(), cv::Mat(3, 4, CV_16UC3, cv::Scalar(1, 2, 3)));
  EXPECT_NE(error_of(folder.path()).find("expected one (grey)"), std::string::npos);
}

TEST(Volume, MultiPageTiff) {
  const ScratchFolder folder;
  std::vector<cv::Mat> pages;
  for (int k = 0; k < 3; ++k) pages.emplace_back(4, 5, CV_16UC1, cv::Scalar(7 + k));
  cv::imwritemulti((folder / "a.tif").string(), pages);
  const Volume volume = read_volume(folder / "a.tif", {2e-6, {}, ""});
  EXPECT_EQ(volume.size, (std::array<std::size_t, 3>{5, 4, 3}));
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(volume.pixels)[40], 9);
}

TEST(Volume, NrrdNamesItsUnit) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  const std::string head =
      "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\nspace dimension: "
      "3\n"
      "space directions: (0.005,0,0) (0,0.005,0) (0,0,0.005)\n";
  write_bytes(folder / "mm.nrrd", head + "space units: \"mm\" \"mm\" \"mm\"\n\n" + bytes_of(volume));
  const Volume read = read_volume(folder / "mm.nrrd");
  EXPECT_TRUE(same_grey(read, volume));
  EXPECT_NEAR(read.spacing, 5e-6, 1e-15);
  write_bytes(folder / "plain.nrrd", head + "\n" + bytes_of(volume));
  EXPECT_NEAR(read_volume(folder / "plain.nrrd").spacing, 5e-9, 1e-18);
  write_bytes(folder / "short.nrrd", head + "\n" + bytes_of(volume).substr(7));
  EXPECT_NE(error_of(folder / "short.nrrd"), "");
}

TEST(Volume, CompressedAndWrittenOutVoxelsAreTheSame) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  const std::string head = "NDims = 3\nElementSpacing = 2 2 2\nDimSize = 5 4 3\nElementType = MET_USHORT\n";
  const std::string packed = deflated(bytes_of(volume));
  const std::string size = "CompressedDataSize = " + std::to_string(packed.size()) + "\n";
  for (const std::string& more : {"CompressedData = True\n" + size, std::string("CompressedData = True\n")}) {
    write_bytes(folder / "a.mha", head + more + "ElementDataFile = LOCAL\n" + packed);
    EXPECT_TRUE(same_grey(read_volume(folder / "a.mha"), volume)) << more;
  }
  write_bytes(folder / "a.mha",
              head + "CompressedData = True\nElementDataFile = LOCAL\n" + packed.substr(0, 20));
  EXPECT_NE(error_of(folder / "a.mha").find("once inflated, expected 120"), std::string::npos);
  std::string text;
  for (const auto grey : std::get<std::vector<std::uint16_t>>(volume.pixels))
    text += std::to_string(grey) + "\n";
  write_bytes(folder / "a.mha", head + "BinaryData = False\nElementDataFile = LOCAL\n" + text);
  EXPECT_TRUE(same_grey(read_volume(folder / "a.mha"), volume));
  write_bytes(
      folder / "a.nrrd",
      "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 5 4 3\nencoding: text\nspacings: 2 2 2\n\n" + text);
  EXPECT_TRUE(same_grey(read_volume(folder / "a.nrrd"), volume));
  write_bytes(
      folder / "a.nrrd",
      "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 5 4 3\nencoding: text\nspacings: 2 2 2\n\n70000 " + text);
  EXPECT_NE(error_of(folder / "a.nrrd").find("from 0 to 65535"), std::string::npos);
}

TEST(Volume, SlicesByListAndPattern) {
  const ScratchFolder folder;
  const Volume volume = ramp();
  const std::string data = bytes_of(volume);
  for (int k = 0; k < 3; ++k)
    write_bytes(folder / fmt::format("s{:02d}.raw", k + 7), "head" + data.substr(40 * k, 40));
  const std::string meta =
      "NDims = 3\nHeaderSize = 4\nElementSpacing = 2 2 2\nDimSize = 5 4 3\nElementType = "
      "MET_USHORT\nElementDataFile = ";
  const std::string nrrd =
      "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n"
      "spacings: 2 2 2\nbyte skip: 4\ndata file: ";
  const struct {
    const char* name;
    std::string bytes;
  } cases[] = {{"a.mhd", meta + "LIST\ns07.raw\ns08.raw\ns09.raw\n"},
               {"b.mhd", meta + "s%02d.raw 7 9 1\n"},
               {"c.mhd", meta + "s%02d.raw 7\n"},
               {"a.nhdr", nrrd + "LIST\ns07.raw\ns08.raw\ns09.raw\n"},
               {"b.nhdr", nrrd + "s%02d.raw 7 9 1 2\n"}};
  for (const auto& c : cases) {
    write_bytes(folder / c.name, c.bytes);
    const Volume read = read_volume(folder / c.name);
    EXPECT_TRUE(same_grey(read, volume)) << c.name;
    EXPECT_EQ(volume_files(folder / c.name).size(), 4u);
  }
  write_bytes(folder / "s08.raw", "head" + data.substr(40, 39));
  for (const auto& c : cases)
    EXPECT_NE(error_of(folder / c.name).find("s08.raw: found 3"), std::string::npos) << c.name;
  fs::remove(folder / "s08.raw");
  for (const auto& c : cases)
    EXPECT_NE(error_of(folder / c.name).find("s08.raw"), std::string::npos) << c.name;
}

TEST(Volume, BadInputIsOneLine) {
  const ScratchFolder folder;
  const auto header = [](const std::string& size, const std::string& type, const std::string& spacing) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nElementSpacing "
           "= " +
           spacing + "\nDimSize = " + size + "\nElementType = " + type + "\nElementDataFile = LOCAL\n";
  };
  const std::string data = bytes_of(ramp());
  std::string not_a_number(60 * sizeof(float), '\0');
  const float nan = std::nanf("");
  not_a_number.replace(4 * sizeof(float), sizeof(float), reinterpret_cast<const char*>(&nan), sizeof(float));
  const struct {
    std::string name, bytes, part;
  } cases[] = {
      {"truncated.mha", header("5 4 3", "MET_USHORT", "2 2 2") + data.substr(20),
       "found 100 bytes of voxels, expected 120"},
      {"lying.mha", header("5 4 4", "MET_USHORT", "2 2 2") + data, "found 120 bytes of voxels, expected 160"},
      {"huge.mha", header("100000 100000 100000", "MET_USHORT", "2 2 2") + data, "found 120 bytes"},
      {"wide.mha", header("5 4 3", "MET_LONG_DOUBLE", "2 2 2") + data, "found pixel type long_double"},
      {"bare.mha", header("5 4 3", "USHORT", "2 2 2") + data, "found pixel type ushort"},
      {"flat.mha", header("5 4 3", "MET_USHORT", "2 2 2") + std::string(120, '\1'),
       "found one grey value throughout"},
      {"slab.mha", header("5 4 3", "MET_USHORT", "2 2 25") + data, "within a factor of 8"},
      {"nan.mha", header("5 4 3", "MET_FLOAT", "2 2 2") + not_a_number, "voxel (4, 0, 0): found NaN"},
      {"empty.mha", "", "empty.mha"},
      {"text.nrrd", "hello", "text.nrrd"},
      {"text.tif", "hello", "text.tif"},
      {"other.txt", "hello", "found extension '.txt'"},
  };
  for (const auto& c : cases) {
    write_bytes(folder / c.name, c.bytes);
    const std::string message = error_of(folder / c.name);
    EXPECT_NE(message.find(c.part), std::string::npos) << c.name << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_THROW(read_volume(folder / "absent.mha"), BadInput);
}

}  // namespace
}  // namespace pendular::segmentation
