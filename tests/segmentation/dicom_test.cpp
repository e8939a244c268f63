// ITK brings an older Eigen: see volume/itk_images.h.
#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include <itkGDCMImageIO.h>
#include <itkImage.h>
#include <itkImageFileWriter.h>
#include <itkMetaDataObject.h>

#include "mutation.h"
#include "read_error.h"
#include "scratch.h"
#include "volume/volume.h"

namespace pendular::segmentation {
namespace {

using test::error_of;
using test::ScratchFolder;

constexpr std::size_t kWide = 6, kDeep = 5, kSlices = 4;

template <typename T>
T grey(std::size_t i, std::size_t j, std::size_t k) {
  return static_cast<T>(100 + i + 10 * j + 100 * k);
}

/// One slice of a series at a height in mm.
template <typename T>
void write_slice(const fs::path& path, std::size_t k, double height, double pixel = 0.005,
                 const std::string& series = "1.2.3.4", std::size_t wide = kWide) {
  using Image = itk::Image<T, 3>;
  auto image = Image::New();
  image->SetRegions(typename Image::SizeType{{wide, kDeep, 1}});
  image->Allocate();
  for (std::size_t j = 0; j < kDeep; ++j)
    for (std::size_t i = 0; i < wide; ++i) image->GetBufferPointer()[j * wide + i] = grey<T>(i, j, k);
  const double spacing[] = {pixel, pixel, pixel}, origin[] = {0.0, 0.0, height};
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  auto io = itk::GDCMImageIO::New();
  io->KeepOriginalUIDOn();
  auto& words = io->GetMetaDataDictionary();
  itk::EncapsulateMetaData<std::string>(words, "0008|0060", "CT");
  itk::EncapsulateMetaData<std::string>(words, "0008|0018", "1.2.3.4.5." + std::to_string(k + 1));
  itk::EncapsulateMetaData<std::string>(words, "0020|000d", "1.2.3");
  itk::EncapsulateMetaData<std::string>(words, "0020|000e", series);
  itk::EncapsulateMetaData<std::string>(words, "0020|0013", std::to_string(k + 1));
  image->SetMetaDataDictionary(words);
  auto writer = itk::ImageFileWriter<Image>::New();
  writer->SetImageIO(io);
  writer->SetInput(image);
  writer->SetFileName(path.string());
  writer->Update();
}

template <typename T>
void expect_ramp(const Volume& volume) {
  ASSERT_EQ(volume.size, (std::array<std::size_t, 3>{kWide, kDeep, kSlices}));
  const auto& pixels = std::get<std::vector<T>>(volume.pixels);
  for (std::size_t k = 0; k < kSlices; ++k)
    for (std::size_t j = 0; j < kDeep; ++j)
      for (std::size_t i = 0; i < kWide; ++i)
        EXPECT_EQ(pixels[(k * kDeep + j) * kWide + i], (grey<T>(i, j, k)));
}

TEST(Dicom, SlicesComeInTheOrderOfTheirPositions) {
  const ScratchFolder folder;
  fs::create_directory(folder / "scan");
  const char* names[] = {"d", "a", "c", "b"};  // not the order of names
  for (std::size_t k = 0; k < kSlices; ++k)
    write_slice<std::uint16_t>(folder / "scan" / names[k], k, 1.0 + 0.005 * static_cast<double>(k));
  const Volume volume = read_volume(folder / "scan");
  expect_ramp<std::uint16_t>(volume);
  EXPECT_NEAR(volume.spacing, 5e-6, 1e-12);
  EXPECT_NEAR(volume.origin.z(), 1e-3, 1e-9);
}

TEST(Dicom, SignedGreyValuesBecomeFloats) {
  const ScratchFolder folder;
  fs::create_directory(folder / "scan");
  for (std::size_t k = 0; k < kSlices; ++k)
    write_slice<std::int16_t>(folder / "scan" / (std::to_string(k) + ".dcm"), k,
                              0.005 * static_cast<double>(k));
  const Volume volume = read_volume(folder / "scan");
  ASSERT_EQ(pixel_type(volume), "float");
  EXPECT_EQ(std::get<std::vector<float>>(volume.pixels)[kWide * kDeep], 200.0F);
}

TEST(Dicom, WhatIsWrongWithASeriesIsOneLine) {
  const ScratchFolder folder;
  const auto series = [&](const char* name, const std::function<void(const fs::path&, std::size_t)>& write) {
    fs::create_directory(folder / name);
    for (std::size_t k = 0; k < kSlices; ++k) write(folder / name / (std::to_string(k) + ".dcm"), k);
    return folder / name;
  };
  const auto height = [](std::size_t k) { return 0.005 * static_cast<double>(k); };
  const auto missing = series("missing", [&](const fs::path& p, std::size_t k) {
    write_slice<std::uint16_t>(p, k, height(k < 2 ? k : k + 1));
  });
  EXPECT_NE(error_of(missing).find("missing"), std::string::npos) << error_of(missing);
  const auto two = series("two", [&](const fs::path& p, std::size_t k) {
    write_slice<std::uint16_t>(p, k, height(k), 0.005, k < 2 ? "1.2.3.4" : "1.2.3.9");
  });
  EXPECT_NE(error_of(two).find("2 DICOM series"), std::string::npos) << error_of(two);
  const auto flat = series(
      "flat", [&](const fs::path& p, std::size_t k) { write_slice<std::uint16_t>(p, k, 2.0 * height(k)); });
  EXPECT_EQ(read_volume(flat).size, (std::array<std::size_t, 3>{kWide, kDeep, 2 * kSlices - 1}));
  ReadOptions options;
  options.spacing = 5e-6;
  EXPECT_EQ(error_of(flat, options), "");
  fs::resize_file(missing / "1.dcm", fs::file_size(missing / "1.dcm") - 20);
  EXPECT_NE(error_of(missing), "");
  EXPECT_EQ(error_of(missing).find('\n'), std::string::npos);
}

TEST(Dicom, NoDamageToASliceCrashesItsReader) {
  const ScratchFolder folder;
  fs::create_directory(folder / "scan");
  for (std::size_t k = 0; k < kSlices; ++k)
    write_slice<std::uint16_t>(folder / "scan" / (std::to_string(k) + ".dcm"), k,
                               0.005 * static_cast<double>(k));
  const std::string good = read_text(folder / "scan" / "2.dcm");
  test::read_mutations(folder / "scan" / "2.dcm", good, 200,
                       [&](const fs::path&) { read_volume(folder / "scan"); });
}

}  // namespace
}  // namespace pendular::segmentation
