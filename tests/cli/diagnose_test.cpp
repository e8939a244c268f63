#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/files.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::Outcome;
using test::ScratchFolder;
using test::shell;

std::string curve(const std::string& header, double stress, bool zero_sigma = false) {
  std::string text = header + "\n";
  for (int k = 0; k < 12; ++k)
    text += fmt::format("{},{}{}\n", 0.008 * k, 1.5e5 * stress * k, zero_sigma ? ",0" : "");
  return text;
}

/// A field of the two beads' specimen, mirrored; places in a row of beads.
std::string field(bool mirrored) {
  std::string text = "strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um\n";
  for (int k = 0; k < 27; ++k) {
    const double x = 205.0 * (k % 3) - 205.0, y = 205.0 * (k / 3 % 3), z = 205.0 * (k / 9);
    text += fmt::format("0.02,{},{},{},{},0,0,{}\n", k + 1, mirrored ? -x : x, y, z, -0.02 * z);
  }
  return text;
}

struct Mistake {
  const char* name;
  std::string kind, table;
  const char* told;
};

class Diagnose : public testing::TestWithParam<Mistake> {};

Outcome diagnose(const ScratchFolder& folder, const std::string& kind, const std::string& table,
                 const std::string& how = "") {
  write_text(folder / "s.toml", test::small_sample());
  std::string beads = "bead_id,x_um,y_um,z_um,diameter_um\n";
  for (int k = 0; k < 27; ++k)
    beads += fmt::format("{},{},{},{},200\n", k + 1, 205 * (k % 3) - 205, 205 * (k / 3 % 3), 205 * (k / 9));
  write_text(folder / "beads.csv", beads);
  write_text(folder / "table.csv", table);
  write_text(folder / "e.toml", "[experiment]\nsample = \"s.toml\"\n[[observation]]\nkind = \"" + kind +
                                    "\"\nfile = \"table.csv\"\n" +
                                    (kind == "displacements" ? "beads = \"beads.csv\"\n" : ""));
  return shell(folder.path(), "$P diagnose e.toml -o out --store store " + how);
}

TEST_P(Diagnose, TellsAMistakeBeforeAnyRunIsMade) {
  ScratchFolder folder;
  const Outcome outcome = diagnose(folder, GetParam().kind, GetParam().table);
  EXPECT_EQ(outcome.status, 3) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  for (const char* told : {"table.csv", "found", "expected", GetParam().told})
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_FALSE(fs::exists(folder / "store" / "runs"));
}

INSTANTIATE_TEST_SUITE_P(
    Table, Diagnose,
    testing::Values(Mistake{"BreaksPerInterval", "broken_bonds", "strain,count\n0.01,5\n0.02,40\n0.03,12\n",
                            "per_interval"},
                    Mistake{"CurveInMegapascals", "compression", curve("strain,stress_pa", 1e-6), "MPa"},
                    Mistake{"BridgesInKilonewtonsPerMetre", "bridge_stiffness",
                            "d_um,D_um,kn_n_per_m,kn_sigma_n_per_m\n74,200,5.76,0.3\n", "kN/m"},
                    Mistake{"FieldMirrored", "displacements", field(true), "mirrored"}),
    [](const auto& test) { return test.param.name; });

TEST(DiagnosePlan, AboutNeedsAPlanAndKnowsItsEffects) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  const auto plan = [&](const std::string& how) {
    return shell(folder.path(), "$P diagnose s.toml -o out --store store --dry-run " + how);
  };
  EXPECT_EQ(plan("--about platen_tilt").status, 2);
  const Outcome unknown = plan("--plan --about platen_tlt");
  EXPECT_EQ(unknown.status, 3) << unknown.errors;
  EXPECT_NE(unknown.errors.find("platen_tilt"), std::string::npos) << unknown.errors;
  EXPECT_EQ(plan("--plan --about platen_tilt").status, 0);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(DiagnoseWarning, TellsWhatIsOddBeforeAnyRunIsMade) {
  ScratchFolder folder;
  const Outcome outcome =
      diagnose(folder, "compression", curve("strain,stress_pa,stress_sigma_pa", 1.0, true), "--dry-run");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("table: stress_sigma_pa holds zeros"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace pendular
