#include <gtest/gtest.h>
#include <hdf5.h>

#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "packing/tables.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"
#include "volume/volume.h"

namespace pendular {
namespace {

using nlohmann::json;
using test::ScratchFolder;
using test::shell;

/// One scan, as other programs write it: the beads that `segment` finds in each file must be those of the
/// MetaImage.
class NeighboursVolumes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>();
    write_text(*folder_ / "s.toml", test::small_sample());
    ASSERT_EQ(run("$P phantom s.toml -o scan.mha && $P segment scan.mha -o mha.csv").status, 0);
    volume_ = read_volume(*folder_ / "scan.mha");
    ASSERT_EQ(pixel_type(volume_), "uint16");
    with_pixels(volume_, [](auto pixels) {
      for (const auto grey : pixels) grey_.push_back(static_cast<std::uint16_t>(grey));
    });
  }
  static void TearDownTestSuite() { folder_.reset(), grey_.clear(); }

  static test::Outcome run(const std::string& command) { return shell(folder_->path(), command); }

  /// The beads of a file against those of the MetaImage, which may begin elsewhere.
  static void expect_same_beads(const std::string& scan, const Vec3& origin) {
    const auto made = run("$P segment " + scan + " -o found.csv");
    ASSERT_EQ(made.status, 0) << made.errors;
    const auto beads = read_beads(*folder_ / "mha.csv"), found = read_beads(*folder_ / "found.csv");
    ASSERT_EQ(found.size(), beads.size());
    ASSERT_GT(beads.size(), 100u);
    for (std::size_t k = 0; k < beads.size(); ++k) {
      EXPECT_LT(((found[k].centre - origin) - (beads[k].centre - volume_.origin)).norm(), 2e-10);
      EXPECT_NEAR(found[k].diameter, beads[k].diameter, 2e-10);
    }
  }

  static std::array<hsize_t, 3> extent() { return {volume_.size[2], volume_.size[1], volume_.size[0]}; }

  static inline std::unique_ptr<ScratchFolder> folder_;
  static inline Volume volume_;
  static inline std::vector<std::uint16_t> grey_;
};

/// A file of HDF5 with groups, datasets and attributes of text.
class File {
 public:
  explicit File(const fs::path& path)
      : id_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~File() { H5Fclose(id_); }

  void group(const char* name) { H5Gclose(H5Gcreate2(id_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); }

  void dataset(const char* name, std::span<const hsize_t> extent, hid_t type, const void* values) {
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (extent.size() == 3) {
      const hsize_t chunk[3] = {16, 64, 64};
      H5Pset_chunk(how, 3, chunk), H5Pset_deflate(how, 1);
    }
    const hid_t set = H5Dcreate2(id_, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(set), H5Pclose(how), H5Sclose(space);
  }

  void attribute(const char* object, const char* name, const std::string& value) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, value.size());
    const hid_t at = H5Oopen(id_, object, H5P_DEFAULT);
    const hid_t attribute = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, value.data());
    H5Aclose(attribute), H5Oclose(at), H5Sclose(space), H5Tclose(type);
  }

 private:
  hid_t id_;
};

TEST_F(NeighboursVolumes, Hdf5ByThePathOfTheDataset) {
  {
    File file(*folder_ / "scan.h5");
    file.group("/exchange");
    file.dataset("/exchange/data", extent(), H5T_NATIVE_UINT16, grey_.data());
    const std::uint16_t other[] = {1, 2, 3};
    file.dataset("/exchange/theta", std::array<hsize_t, 1>{3}, H5T_NATIVE_UINT16, other);
  }
  expect_same_beads("scan.h5:/exchange/data --voxel-um 10", Vec3::Zero());
  const auto wrong = run("$P segment scan.h5:/exchange/theta --voxel-um 10 -o wrong.csv");
  EXPECT_EQ(wrong.status, 3);
  EXPECT_NE(wrong.errors.find("scan.h5:/exchange/theta"), std::string::npos) << wrong.errors;
  EXPECT_FALSE(fs::exists(*folder_ / "wrong.csv"));
}

TEST_F(NeighboursVolumes, NexusBySignalAndAxes) {
  {
    File file(*folder_ / "scan.nxs");
    file.group("/entry");
    file.group("/entry/reconstruction");
    file.dataset("/entry/reconstruction/grey", extent(), H5T_NATIVE_UINT16, grey_.data());
    const char* names[] = {"/entry/reconstruction/x", "/entry/reconstruction/y", "/entry/reconstruction/z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> place;
      for (std::size_t k = 0; k < volume_.size[axis]; ++k)
        place.push_back(1e3 *
                        (volume_.origin[static_cast<int>(axis)] + volume_.spacing * static_cast<double>(k)));
      file.dataset(names[axis], std::array<hsize_t, 1>{place.size()}, H5T_NATIVE_DOUBLE, place.data());
      file.attribute(names[axis], "units", "mm");
    }
    file.attribute("/", "default", "entry");
    file.attribute("/entry", "default", "reconstruction");
    file.attribute("/entry/reconstruction", "signal", "grey");
  }
  expect_same_beads("scan.nxs", volume_.origin);
}

TEST_F(NeighboursVolumes, OmeZarrByItsScale) {
  const fs::path level = *folder_ / "scan.zarr" / "0";
  fs::create_directories(level);
  const auto nz = volume_.size[2], slice = volume_.size[0] * volume_.size[1];
  const std::vector<double> scale(3, 1e6 * volume_.spacing),
      origin = {1e6 * volume_.origin.z(), 1e6 * volume_.origin.y(), 1e6 * volume_.origin.x()};
  json axes = json::array(), changes = json::array();
  for (const char* name : {"z", "y", "x"})
    axes.push_back({{"name", name}, {"type", "space"}, {"unit", "micrometer"}});
  changes.push_back({{"type", "scale"}, {"scale", scale}});
  changes.push_back({{"type", "translation"}, {"translation", origin}});
  const json image = {{"version", "0.4"},
                      {"axes", axes},
                      {"datasets", json::array({{{"path", "0"}, {"coordinateTransformations", changes}}})}};
  write_text(*folder_ / "scan.zarr" / ".zgroup", R"({"zarr_format": 2})");
  write_text(*folder_ / "scan.zarr" / ".zattrs", json{{"multiscales", json::array({image})}}.dump());
  write_text(level / ".zarray", json{{"zarr_format", 2},
                                     {"shape", extent()},
                                     {"chunks", {1, volume_.size[1], volume_.size[0]}},
                                     {"dtype", "<u2"},
                                     {"compressor", nullptr},
                                     {"fill_value", 0},
                                     {"order", "C"},
                                     {"filters", nullptr}}
                                    .dump());
  for (std::size_t z = 0; z < nz; ++z)
    write_text(level / fmt::format("{}.0.0", z),
               std::string(reinterpret_cast<const char*>(&grey_[z * slice]), 2 * slice));
  expect_same_beads("scan.zarr", volume_.origin);

  fs::remove(level / "3.0.0");
  const auto holed = run("$P segment scan.zarr -o wrong.csv");
  EXPECT_EQ(holed.status, 3);
  EXPECT_NE(holed.errors.find("3.0.0: found no such chunk"), std::string::npos) << holed.errors;
}

/// spam's table of the beads of a scan and where they went: x by 2 %, y by 1 voxel, z by −3 % of the place.
void write_ddic(const std::vector<Bead>& beads, double voxel, const fs::path& path) {
  std::string text = "Label\tZpos\tYpos\tXpos\tZdisp\tYdisp\tXdisp\treturnStatus\tradius\n";
  for (const Bead& bead : beads) {
    const Vec3 at = bead.centre / voxel;
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t2\t{}\n", bead.id, at.z(), at.y(), at.x(),
                        -0.03 * at.z(), 1.0, 0.02 * at.x(), 0.5 * bead.diameter / voxel);
  }
  write_text(path, text);
}

TEST(NeighboursTables, BeadsAndDisplacementsOfSpamArePackedAndTracked) {
  const ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  const auto run = [&](const std::string& command) {
    const auto done = shell(folder.path(), command);
    ASSERT_EQ(done.status, 0) << command << ": " << done.errors;
  };
  run("$P pack --generate --sample s.toml -o p.vtp && $P convert p.vtp beads.csv");
  const auto beads = read_beads(folder / "beads.csv");
  write_ddic(beads, 1e-5, folder / "a-ddic.tsv");
  run("$P convert a-ddic.tsv before.csv --voxel-um 10");
  run("$P convert a-ddic.tsv after.csv --voxel-um 10 --displaced");
  run("$P pack before.csv --sample s.toml -o packing.vtp");
  const auto before = read_beads(folder / "before.csv"), after = read_beads(folder / "after.csv");
  ASSERT_EQ(before.size(), beads.size());
  ASSERT_EQ(after.size(), beads.size());
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const Vec3& at = beads[k].centre;
    EXPECT_LT((before[k].centre - at).norm(), 2e-10);
    EXPECT_LT((after[k].centre - Vec3(1.02 * at.x(), at.y() + 1e-5, 0.97 * at.z())).norm(), 2e-10);
    EXPECT_NEAR(before[k].diameter, beads[k].diameter, 2e-10);
  }

  // An even strain of −3 % along z and 2 % along x, no rotation: what is left of it once the frame is found.
  run("$P track before.csv after.csv -o track.csv --strain 0.03");
  const CsvTable track = read_csv(folder / "track.csv", {"z_um", "uz_um"});
  const auto z = track.numbers("z_um"), dz = track.numbers("uz_um");
  ASSERT_GT(z.size(), beads.size() * 95 / 100);
  double zz = 0.0, zd = 0.0, mean = 0.0;
  for (const double value : z) mean += value / static_cast<double>(z.size());
  for (std::size_t k = 0; k < z.size(); ++k) zz += (z[k] - mean) * (z[k] - mean), zd += (z[k] - mean) * dz[k];
  EXPECT_NEAR(zd / zz, -0.03, 0.001);
}

}  // namespace
}  // namespace pendular
