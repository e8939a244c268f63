#include <gtest/gtest.h>
#include <hdf5.h>

#include <numeric>

#include "mutation.h"
#include "read_error.h"
#include "scratch.h"

namespace pendular::segmentation {
namespace {

using test::error_of;
using test::ScratchFolder;

constexpr std::array<hsize_t, 3> kExtent = {5, 6, 7};  // z, y, x

std::vector<std::uint16_t> ramp() {
  std::vector<std::uint16_t> values(5 * 6 * 7);
  std::iota(values.begin(), values.end(), std::uint16_t{300});
  return values;
}

/// Writes HDF5 files as other programs do. Identifiers are closed with the file.
class File {
 public:
  explicit File(const fs::path& path)
      : id_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~File() { H5Fclose(id_); }

  void group(const std::string& name) {
    H5Gclose(H5Gcreate2(id_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }

  /// A dataset whose values are given as uint16; in chunks where `chunk` is not empty.
  void dataset(const std::string& name, const std::vector<hsize_t>& extent, hid_t type,
               const std::vector<std::uint16_t>& values, const std::vector<hsize_t>& chunk = {},
               bool deflated = false) {
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (!chunk.empty()) H5Pset_chunk(how, static_cast<int>(chunk.size()), chunk.data());
    if (deflated) H5Pset_deflate(how, 4);
    const hid_t set = H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(set, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set), H5Pclose(how), H5Sclose(space);
  }

  /// Writes only the first chunk of a dataset.
  void first_slab(const std::string& name, hsize_t slices) {
    const hid_t set = H5Dopen2(id_, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
    const hsize_t first[3] = {0, 0, 0}, count[3] = {slices, kExtent[1], kExtent[2]};
    const hid_t memory = H5Screate_simple(3, count, nullptr);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, count, nullptr);
    H5Dwrite(set, H5T_NATIVE_UINT16, memory, space, H5P_DEFAULT, ramp().data());
    H5Sclose(memory), H5Sclose(space), H5Dclose(set);
  }

  void numbers(const std::string& name, const std::vector<double>& values, const std::string& unit) {
    const hsize_t length = values.size();
    const hid_t space = H5Screate_simple(1, &length, nullptr);
    const hid_t set =
        H5Dcreate2(id_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set), H5Sclose(space);
    text_attribute(name, "units", unit, true);
  }

  void text(const std::string& name, const std::string& value) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, value.size());
    const hid_t set = H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data());
    H5Dclose(set), H5Sclose(space), H5Tclose(type);
  }

  void text_attribute(const std::string& object, const char* name, const std::string& value, bool variable) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, variable ? H5T_VARIABLE : value.size());
    const hid_t at = H5Oopen(id_, object.c_str(), H5P_DEFAULT);
    const hid_t attribute = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const char* text = value.c_str();
    H5Awrite(attribute, type, variable ? static_cast<const void*>(&text) : static_cast<const void*>(text));
    H5Aclose(attribute), H5Oclose(at), H5Sclose(space), H5Tclose(type);
  }

  void edges(const std::string& object, const std::array<double, 3>& zyx) {
    const hsize_t three = 3;
    const hid_t space = H5Screate_simple(1, &three, nullptr), at = H5Oopen(id_, object.c_str(), H5P_DEFAULT);
    const hid_t attribute =
        H5Acreate2(at, "element_size_um", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, zyx.data());
    H5Aclose(attribute), H5Oclose(at), H5Sclose(space);
  }

 private:
  hid_t id_;
};

std::vector<double> greys(const Volume& volume) {
  return with_pixels(volume, [](auto pixels) {
    std::vector<double> values;
    for (const auto grey : pixels) values.push_back(static_cast<double>(grey));
    return values;
  });
}

void expect_ramp(const Volume& volume) {
  EXPECT_EQ(volume.size, (std::array<std::size_t, 3>{7, 6, 5}));
  const auto values = ramp();
  EXPECT_EQ(greys(volume), std::vector<double>(values.begin(), values.end()));
}

const std::vector<hsize_t> kZyx(kExtent.begin(), kExtent.end());
const ReadOptions kMicron{.spacing = 1e-6, .raw_size = {}, .raw_type = {}};

TEST(Hdf5, ADatasetComesBackHoweverItIsLaidOut) {
  const ScratchFolder scratch;
  for (const auto& [type, kind] : {std::pair{H5T_STD_U16LE, "uint16"}, std::pair{H5T_STD_U16BE, "uint16"},
                                   std::pair{H5T_STD_I16LE, "float"}, std::pair{H5T_IEEE_F32BE, "float"},
                                   std::pair{H5T_IEEE_F64LE, "float"}, std::pair{H5T_STD_U32LE, "uint32"},
                                   std::pair{H5T_STD_I64LE, "float"}})
    for (const std::vector<hsize_t>& chunk : {std::vector<hsize_t>{}, {2, 4, 3}, {5, 6, 7}})
      for (const bool deflated : {false, true}) {
        if (deflated && chunk.empty()) continue;
        File(scratch / "a.h5").dataset("/scan", kZyx, type, ramp(), chunk, deflated);
        const Volume volume = read_volume(scratch / "a.h5:/scan", kMicron);
        EXPECT_EQ(pixel_type(volume), kind);
        expect_ramp(volume);
      }
}

TEST(Hdf5, PlainVoxelsStayInTheirFile) {
  const ScratchFolder scratch;
  File(scratch / "a.h5").dataset("/scan", kZyx, H5T_STD_U16LE, ramp());
  const Volume volume = read_volume(scratch / "a.h5", kMicron);
  EXPECT_NE(volume.file, nullptr);
  expect_ramp(volume);
  EXPECT_EQ(volume_files(scratch / "a.h5:/scan"), std::vector<fs::path>{scratch / "a.h5"});
}

TEST(Hdf5, LeadingAxesOfLengthOneAreLeftOut) {
  const ScratchFolder scratch;
  File(scratch / "a.hdf5").dataset("/t", {1, 1, 5, 6, 7}, H5T_STD_U16LE, ramp(), {1, 1, 2, 6, 7});
  expect_ramp(read_volume(scratch / "a.hdf5", kMicron));
}

TEST(Hdf5, VoxelSizeFromTheFile) {
  const ScratchFolder scratch;
  {
    File file(scratch / "a.h5");
    file.dataset("/scan", kZyx, H5T_STD_U16LE, ramp());
    file.edges("/scan", {1.0, 1.0, 1.0});
  }
  EXPECT_DOUBLE_EQ(read_volume(scratch / "a.h5").spacing, 1e-6);
  {
    File file(scratch / "b.nxs");
    file.group("/entry");
    file.group("/entry/data");
    file.dataset("/entry/data/data", kZyx, H5T_STD_U16LE, ramp());
    file.numbers("/entry/data/x", {-0.015, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015}, "mm");
    file.numbers("/entry/data/y", {0, 5, 10, 15, 20, 25}, "micron");
    file.numbers("/entry/data/z", {0, 5e-6, 10e-6, 15e-6, 20e-6}, "m");
  }
  for (const char* name : {"b.nxs", "b.nxs:/entry/data", "b.nxs:/entry/data/data"}) {
    const Volume volume = read_volume(scratch / name);
    EXPECT_NEAR(volume.spacing, 5e-6, 1e-15);
    EXPECT_NEAR(volume.origin.x(), -15e-6, 1e-15);
    expect_ramp(volume);
  }
}

TEST(Hdf5, NexusDefaultsAndSignalsLeadToTheVolume) {
  const ScratchFolder scratch;
  {
    File file(scratch / "a.nxs");
    file.group("/entry");
    file.group("/entry/reconstruction");
    file.dataset("/entry/reconstruction/grey", kZyx, H5T_STD_U16LE, ramp());
    file.dataset("/other", {3, 3, 3}, H5T_STD_U16LE, std::vector<std::uint16_t>(27, 1));
    file.text_attribute("/", "default", "entry", false);
    file.text_attribute("/entry", "default", "reconstruction", true);
    file.text_attribute("/entry/reconstruction", "signal", "grey", true);
  }
  expect_ramp(read_volume(scratch / "a.nxs", kMicron));
}

TEST(Hdf5, ProjectionsAreNoVolumeUnlessTheirDatasetIsNamed) {
  const ScratchFolder scratch;
  {
    File file(scratch / "a.nxs");
    file.group("/entry");
    file.text("/entry/definition", "NXtomo");
    file.group("/entry/data");
    file.dataset("/entry/data/data", kZyx, H5T_STD_U16LE, ramp());
  }
  EXPECT_NE(error_of(scratch / "a.nxs", kMicron).find("found projections (NXtomo)"), std::string::npos);
  expect_ramp(read_volume(scratch / "a.nxs:/entry/data", kMicron));
}

TEST(Hdf5, WhatIsWrongIsSaidInOneLine) {
  const ScratchFolder scratch;
  const auto expect = [&](const std::string& name, const std::string& part) {
    const std::string error = error_of(scratch / name, kMicron);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  };
  write_text(scratch / "text.h5", "no HDF5 at all");
  {
    File file(scratch / "a.h5");
    file.group("/entry");
    file.dataset("/entry/flat", {6, 7}, H5T_STD_U16LE, {});
    file.dataset("/entry/four", {2, 3, 3, 3}, H5T_STD_U16LE, std::vector<std::uint16_t>(54, 1));
    file.dataset("/entry/wide", kZyx, H5T_NATIVE_LDOUBLE, ramp());
    file.dataset("/entry/part", kZyx, H5T_STD_U16LE, {}, {2, 6, 7});
    file.first_slab("/entry/part", 2);
    file.dataset("/entry/none", kZyx, H5T_STD_U16LE, {});
    file.text("/entry/text", "words");
  }
  expect("text.h5", "found no HDF5 file, expected one");
  expect("text.h5:/a", "found no HDF5 file, expected one");
  expect("missing.h5:/a", "missing.h5: no such file");
  expect("a.h5", "found no name of a dataset (a.h5:/...), expected one of three dimensions: /entry/four");
  expect("a.h5:/entry/nowhere",
         "found no dataset /entry/nowhere, expected one of three dimensions: /entry/four");
  expect("a.h5:/entry", "found no dataset /entry,");
  expect("a.h5:/entry/flat", "found dimensions (6, 7), expected three");
  expect("a.h5:/entry/four", "found dimensions (2, 3, 3, 3), expected three");
  expect("a.h5:/entry/wide", "found floats of 16 bytes");
  expect("a.h5:/entry/text", "expected three");
  expect("a.h5:/entry/part", "found 1 chunks, expected 3: the dataset is incomplete");
  expect("a.h5:/entry/none", "found no voxels written");
}

TEST(Hdf5, DamagedFilesEndInOneLine) {
  const ScratchFolder scratch;
  File(scratch / "a.h5").dataset("/scan", kZyx, H5T_STD_U16LE, ramp(), {2, 6, 7}, true);
  const std::string good = read_text(scratch / "a.h5");
  write_text(scratch / "cut.h5", good.substr(0, good.size() / 2));
  EXPECT_NE(error_of(scratch / "cut.h5", kMicron), "");
  test::read_mutations(scratch / "bad.h5", good, 200,
                       [](const fs::path& path) { read_volume(path, kMicron); });
}

}  // namespace
}  // namespace pendular::segmentation
