#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/random.h"
#include "packing/polydata.h"
#include "packing/tables.h"
#include "picture.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shell;

/// How a scan's frame lies in that of the simulation.
struct Frame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1.0;
  Vec3 shift = Vec3::Zero();
};

/// A turned, shifted and drifted frame.
Frame another_frame() {
  return {Eigen::AngleAxisd(2.5, Vec3(0.3, -0.8, 0.5).normalized()).toRotationMatrix(), 1.013,
          Vec3(7e-3, -2e-3, 5e-3)};
}

/// A run's frame as a scan shows it, the beads in another order than in other scans.
void write_scan(const fs::path& state, const fs::path& path, std::uint64_t seed, const Frame& frame = {}) {
  const PolyTable table = read_polydata(state);
  const auto ids = integers(table, true, "bead_id", state);
  const auto diameters = numbers(table, true, "diameter_um", state);
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    Bead bead;
    bead.id = ids[k];
    bead.sigma_centre = bead.sigma_diameter = 0.2e-6;
    bead.diameter = frame.scale * 1e-6 * diameters[k] + bead.sigma_diameter * random_normal(seed, 4 * k);
    Vec3 centre;
    for (int axis = 0; axis < 3; ++axis) centre[axis] = 1e-6 * table.points[k][axis];
    bead.centre = frame.scale * (frame.rotation * centre) + frame.shift;
    for (int axis = 0; axis < 3; ++axis)
      bead.centre[axis] +=
          bead.sigma_centre * random_normal(seed, 4 * k + 1 + static_cast<std::size_t>(axis));
    beads.push_back(bead);
  }
  if (seed % 2 == 0) std::reverse(beads.begin(), beads.end());
  write_beads(path, beads, {});
}

/// Two scans of a run, the second in another frame: before.csv and after.csv.
void write_scans(const ScratchFolder& folder) {
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  ASSERT_EQ(shell(folder.path(), "$P compress p.vtp --sample s.toml -o run").status, 0);
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder / "run/frames")) frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  write_scan(frames.front(), folder / "before.csv", 1);
  write_scan(frames.back(), folder / "after.csv", 2, another_frame());
}

/// A line of a table of beads; the diameter as any bead's.
std::string bead(int id, const std::string& x) {
  return fmt::format("{},{},0,0,200\n", id, x);
}

constexpr const char* kHeader = "bead_id,x_um,y_um,z_um,diameter_um\n";

TEST(Track, FollowsTheBeadsOfACompressedSpecimen) {
  ScratchFolder folder;
  write_scans(folder);
  const auto done =
      shell(folder.path(), "$P track before.csv after.csv -o track.csv --strain 0.02 --pictures pictures");
  ASSERT_EQ(done.status, 0) << done.errors;
  const CsvTable table = read_csv(folder / "track.csv", {"strain", "bead_id", "bead_id_after", "x_um",
                                                         "uz_um", "sigma_um", "shear_strain", "state"});
  const auto before = table.integers("bead_id"), after = table.integers("bead_id_after");
  const auto all = read_beads(folder / "before.csv").size();
  EXPECT_GE(static_cast<double>(before.size()), 0.99 * static_cast<double>(all));
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before[k], after[k]);
  for (const double sigma : table.numbers("sigma_um"))
    EXPECT_NEAR(sigma, 0.2 * std::hypot(1.0, 1.0 / 1.013), 1e-4);
  EXPECT_EQ(table.numbers("strain").front(), 0.02);
  for (const char* name : {"shear_strain", "displacement_cut"}) {
    const double drawn = test::drawn_share(test::picture(folder / "pictures" / (std::string(name) + ".png")));
    EXPECT_GT(drawn, 0.15) << name;
    EXPECT_LT(drawn, 0.9) << name;
  }

  const auto json = nlohmann::json::parse(content(folder / "track.json"));
  EXPECT_EQ(json["matched"].get<std::size_t>(), before.size());
  EXPECT_EQ(json["lost"]["count"].get<std::size_t>(), all - before.size());
  EXPECT_EQ(json["new"]["ids"].size(), json["new"]["count"].get<std::size_t>());
  EXPECT_FALSE(json["nothing_moved"].get<bool>());
  const auto& registration = json["registration"];
  EXPECT_LE(std::fabs(registration["scale"].get<double>() - 1.013),
            4.0 * registration["scale_sigma"].get<double>());
  EXPECT_NEAR(registration["angle_deg"].get<double>(), 2.5 * 180.0 / M_PI, 0.5);
  Eigen::Matrix3d rotation;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      rotation(static_cast<int>(row), static_cast<int>(column)) = registration["rotation"][row][column];
  const Eigen::Matrix3d off = rotation.transpose() * another_frame().rotation;
  EXPECT_LT(Eigen::AngleAxisd(off).angle() * 180.0 / M_PI, 0.5);

  ASSERT_EQ(shell(folder.path(), "$P track before.csv after.csv -o one.csv --strain 0.02 --threads 1").status,
            0);
  const auto rows = [&](const char* name) {
    const std::string text = content(folder / name);
    return text.substr(text.find("strain,bead_id"));
  };
  EXPECT_EQ(rows("track.csv"), rows("one.csv"));
}

TEST(Track, TheSameScanAgainIsSaid) {
  ScratchFolder folder;
  write_scans(folder);
  const auto done = shell(folder.path(), "$P track before.csv before.csv -o track.csv --quiet");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.errors.find("nothing moved"), std::string::npos) << done.errors;
  EXPECT_EQ(std::count(done.errors.begin(), done.errors.end(), '\n'), 1) << done.errors;
  EXPECT_TRUE(nlohmann::json::parse(content(folder / "track.json"))["nothing_moved"].get<bool>());
}

TEST(Track, ErrorsThatAreNotStatedHaveNoColumn) {
  ScratchFolder folder;
  write_scans(folder);
  auto beads = read_beads(folder / "after.csv");
  for (auto& one : beads) one.sigma_centre = 0.0;
  write_beads(folder / "after.csv", beads, {});
  ASSERT_EQ(shell(folder.path(), "$P track before.csv after.csv -o track.csv").status, 0);
  EXPECT_FALSE(read_csv(folder / "track.csv", {"bead_id"}).has("sigma_um"));
}

TEST(Track, AMirroredScanIsOneLineThatSaysSo) {
  ScratchFolder folder;
  write_scans(folder);
  auto beads = read_beads(folder / "after.csv");
  for (auto& one : beads) one.centre.y() = -one.centre.y();
  write_beads(folder / "mirrored.csv", beads, {});
  const auto refused = shell(folder.path(), "$P track before.csv mirrored.csv -o track.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.errors.find("mirrored.csv: the constellation matches mirrored"), std::string::npos)
      << refused.errors;
  EXPECT_EQ(std::count(refused.errors.begin(), refused.errors.end(), '\n'), 1) << refused.errors;
  EXPECT_FALSE(fs::exists(folder / "track.csv"));
}

TEST(Track, BadTablesAreOneLineThatNamesTheFile) {
  ScratchFolder folder;
  std::string good = kHeader, few = kHeader, twice = kHeader, not_a_number = kHeader;
  for (int k = 0; k < 12; ++k) {
    const std::string place = std::to_string(250 * k);
    good += bead(k, place);
    if (k < 9) few += bead(k, place);
    twice += bead(k == 7 ? 3 : k, place);
    not_a_number += bead(k, k == 7 ? "nan" : place);
  }
  write_text(folder / "good.csv", good);
  write_text(folder / "few.csv", few);
  write_text(folder / "twice.csv", twice);
  write_text(folder / "not_a_number.csv", not_a_number);
  for (const std::string name : {"few.csv", "twice.csv", "not_a_number.csv"})
    for (const std::string& files : {name + " good.csv", "good.csv " + name}) {
      const auto refused = shell(folder.path(), "$P track " + files + " -o track.csv");
      EXPECT_EQ(refused.status, 3) << files;
      EXPECT_NE(refused.errors.find(name), std::string::npos) << refused.errors;
      EXPECT_EQ(std::count(refused.errors.begin(), refused.errors.end(), '\n'), 1) << refused.errors;
      EXPECT_FALSE(fs::exists(folder / "track.csv"));
    }
}

TEST(Track, AnotherSpecimenIsOneLineAndNoTable) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(),
                  "$P pack --generate --sample s.toml -o a.vtp --seed 1 && $P pack --generate --sample "
                  "s.toml -o b.vtp --seed 2 && $P convert a.vtp a.csv && $P convert b.vtp b.csv")
                .status,
            0);
  const auto refused = shell(folder.path(), "$P track a.csv b.csv -o track.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.errors.find("b.csv"), std::string::npos) << refused.errors;
  EXPECT_EQ(std::count(refused.errors.begin(), refused.errors.end(), '\n'), 1) << refused.errors;
  EXPECT_FALSE(fs::exists(folder / "track.csv"));
}

}  // namespace
}  // namespace pendular
