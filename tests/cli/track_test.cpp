#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/random.h"
#include "packing/polydata.h"
#include "packing/tables.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shell;

/// A run's frame as a scan shows it, the beads in another order than in other scans.
void write_scan(const fs::path& frame, const fs::path& path, std::uint64_t seed) {
  const PolyTable table = read_polydata(frame);
  const auto ids = integers(table, true, "bead_id", frame);
  const auto diameters = numbers(table, true, "diameter_um", frame);
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    Bead bead;
    bead.id = ids[k];
    bead.sigma_centre = bead.sigma_diameter = 0.2e-6;
    bead.diameter = 1e-6 * diameters[k] + bead.sigma_diameter * random_normal(seed, 4 * k);
    for (int axis = 0; axis < 3; ++axis)
      bead.centre[axis] = 1e-6 * table.points[k][axis] +
                          bead.sigma_centre * random_normal(seed, 4 * k + 1 + static_cast<std::size_t>(axis));
    beads.push_back(bead);
  }
  if (seed % 2 == 0) std::reverse(beads.begin(), beads.end());
  write_beads(path, beads, {});
}

TEST(Track, FollowsTheBeadsOfACompressedSpecimen) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  ASSERT_EQ(shell(folder.path(), "$P compress p.vtp --sample s.toml -o run").status, 0);
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder / "run/frames")) frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  write_scan(frames.front(), folder / "before.csv", 1);
  write_scan(frames.back(), folder / "after.csv", 2);

  const auto done =
      shell(folder.path(), "$P track before.csv after.csv -o track.csv --strain 0.02 --pictures pictures");
  ASSERT_EQ(done.status, 0) << done.errors;
  const CsvTable table =
      read_csv(folder / "track.csv", {"strain", "bead_id", "bead_id_after", "x_um", "uz_um", "shear_strain"});
  const auto before = table.integers("bead_id"), after = table.integers("bead_id_after");
  const auto all = read_beads(folder / "before.csv").size();
  EXPECT_GE(static_cast<double>(before.size()), 0.99 * static_cast<double>(all));
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before[k], after[k]);
  EXPECT_EQ(table.numbers("strain").front(), 0.02);
  EXPECT_GT(fs::file_size(folder / "pictures/shear_strain.png"), 5000u);
  const auto json = nlohmann::json::parse(content(folder / "track.json"));
  EXPECT_EQ(json["matched"].get<std::size_t>(), before.size());

  ASSERT_EQ(shell(folder.path(), "$P track before.csv after.csv -o one.csv --strain 0.02 --threads 1").status,
            0);
  const auto rows = [&](const char* name) {
    const std::string text = content(folder / name);
    return text.substr(text.find("strain,bead_id"));
  };
  EXPECT_EQ(rows("track.csv"), rows("one.csv"));
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
