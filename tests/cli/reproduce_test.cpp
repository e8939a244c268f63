#include <gtest/gtest.h>

#include "base/csv.h"
#include "base/files.h"
#include "picture.h"
#include "program.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shell;

/// About a hundred beads; stiffness by finite elements.
void write_folder(const fs::path& folder) {
  make_folder(folder);
  write_text(folder / "s.toml",
             test::sample_file("[specimen]\ndiameter_um = 1000\nheight_um = 1000\nvolume_fraction = 0.53\n"
                               "[contact]\nbond_friction_limit = false\n"
                               "[compression]\nmax_strain = 0.08\nframes = 1\nspeed = 1e-3\n"));
  const auto sweep = [&](const std::string& name, const std::string& rest) {
    write_text(folder / (name + ".toml"),
               "[sweep]\nname = \"" + name + "\"\nsample = \"s.toml\"\nrealisations = 2\n" + rest);
  };
  sweep("realisations_a", "keep = \"all\"\n");
  sweep("realisations_b", "[grid]\n\"specimen.height_um\" = [1100]\n");
  sweep("modulus_of_e_p",
        "[grid]\n\"bridges.gap_um\" = [2, 1]\n\"bridges.youngs_modulus_pa\" = [1.5e5, 1.5e6]\n");
  sweep("modulus_of_content", "[grid]\nW = [0.01, 0.02, 0.04]\n");
  sweep("sensitivity", "[grid]\n\"contact.stiffness_ratio\" = [10, 5]\n");
  sweep("volume_fraction", "[grid]\n\"specimen.volume_fraction\" = [0.48, 0.53]\n");
}

TEST(Reproduce, MakesTheReportWithEveryFigureAndItsTable) {
  ScratchFolder folder;
  write_folder(folder / "paper");
  const auto outcome = shell(folder.path(), "$P reproduce paper -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const fs::path out = folder / "out";
  const std::string report = content(out / "report.md");
  for (const char* heading :
       {"## Single bridges", "## Sample A", "## Sample B", "## Bridges per bead against the cut-off",
        "## Whole specimen and smaller cylinder", "## E against E_p", "## E against W",
        "## What E and its limit", "## Failure against the volume fraction", "## What is not matched"})
    EXPECT_NE(report.find(heading), std::string::npos) << heading;
  EXPECT_NE(report.find("| realisations | at least 5 | 2 | **no** |"), std::string::npos);
  EXPECT_NE(report.find("contact.stiffness_ratio = 5"), std::string::npos);
  EXPECT_EQ(report.find("nan"), std::string::npos);

  struct Case {
    const char* file;
    std::vector<std::string> columns;
  };
  for (const auto& [file, columns] :
       {Case{"bridges", {"gap_um", "d_um", "kn_n_per_m", "kt_n_per_m"}},
        Case{"curves_a", {"realisation", "strain", "stress_pa", "breaks_in_bin"}},
        Case{"curves_b", {"realisation", "strain", "stress_pa", "breaks_in_bin"}},
        Case{"coordination", {"specimen", "cutoff_over_d", "z"}},
        Case{"modulus_of_e_p", {"gap_um", "E_p_pa", "modulus_pa", "kn_n_per_m"}},
        Case{"modulus_of_content", {"W", "modulus_pa", "kn_n_per_m"}},
        Case{"volume_fraction", {"volume_fraction", "strain", "stress_pa"}}}) {
    EXPECT_NE(report.find(std::string("(") + file + ".png)"), std::string::npos) << file;
    EXPECT_GT(test::drawn_share(test::picture(out / (std::string(file) + ".png"))), 0.005) << file;
    const CsvTable table = read_csv(out / (std::string(file) + ".csv"), columns);
    EXPECT_GE(table.rows(), 3u) << file;
    for (const auto& column : columns) EXPECT_EQ(table.numbers(column).size(), table.rows());
  }
  EXPECT_TRUE(fs::exists(out / "band_a" / "shear_strain_end.png")) << "its frames are kept";
}

/// The law of the model: while no bond breaks, all stresses are proportional to the bonds' stiffness.
TEST(Reproduce, SoftPolymersGiveOneCurveInModelUnits) {
  ScratchFolder folder;
  make_folder(folder / "paper");
  write_folder(folder / "paper");
  for (const char* name :
       {"realisations_a", "realisations_b", "modulus_of_content", "sensitivity", "volume_fraction"})
    fs::remove(folder / "paper" / (std::string(name) + ".toml"));
  write_text(folder / "paper" / "modulus_of_e_p.toml",
             "[sweep]\nsample = \"s.toml\"\n[grid]\n\"bridges.youngs_modulus_pa\" = [1e3, 1e4]\n");
  ASSERT_EQ(shell(folder.path(), "$P reproduce paper -o out").status, 0);
  const CsvTable table = read_csv(folder / "out" / "modulus_of_e_p.csv", {"modulus_pa", "kn_n_per_m"});
  const auto modulus = table.numbers("modulus_pa"), kn = table.numbers("kn_n_per_m");
  ASSERT_EQ(modulus.size(), 2u);
  EXPECT_NEAR(kn[1] / kn[0], 10.0, 1e-4);
  EXPECT_NEAR(modulus[1] / modulus[0], 10.0, 0.05);
}

TEST(Reproduce, GoesOnFromItsStoreToTheSameBytes) {
  ScratchFolder folder;
  write_folder(folder / "paper");
  fs::remove(folder / "paper" / "volume_fraction.toml");
  ASSERT_EQ(shell(folder.path(), "$P reproduce paper -o out --realisations 1").status, 0);
  const std::string report = content(folder / "out" / "report.md");
  const auto made = fs::last_write_time(folder / "out" / "store" / "runs");
  ASSERT_EQ(shell(folder.path(), "$P reproduce paper -o out --realisations 1 --resume --threads 1").status,
            0);
  EXPECT_EQ(content(folder / "out" / "report.md"), report);
  EXPECT_EQ(fs::last_write_time(folder / "out" / "store" / "runs"), made);
}

TEST(Reproduce, AFolderWithoutItsSweepsIsBadInput) {
  ScratchFolder folder;
  make_folder(folder / "empty");
  const auto outcome = shell(folder.path(), "$P reproduce empty -o out");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.errors.find("expected some of realisations_a.toml"), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_EQ(shell(folder.path(), "$P reproduce absent -o out").status, 2);
}

}  // namespace
}  // namespace pendular
