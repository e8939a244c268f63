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

struct BadCommand {
  const char* name;
  const char* command;
  int status;
  const char* expected;  ///< part of the one line
};

class BadInput : public testing::TestWithParam<BadCommand> {};

constexpr const char* kTwoBeads = "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,200\n2,0,0,205,200\n";
constexpr const char* kStated = "bead_id,x_um,y_um,z_um,diameter_um,sigma_centre_um,sigma_diameter_um\n";

TEST_P(BadInput, GivesOneLineAndTheRightStatus) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  write_text(folder / "typo.toml", "[beads]\ndiametr_um = 200\n");
  write_text(folder / "half_stiffness.toml", "[bridges]\nnormal_stiffness_n_per_m = 5760\n");
  write_text(folder / "two_stiffnesses.toml",
             "[bridges]\nstiffness = \"per_bridge\"\nnormal_stiffness_n_per_m = 5760\n"
             "tangential_stiffness_n_per_m = 325\n");
  write_text(folder / "two.csv", kTwoBeads);
  write_text(folder / "one.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,200\n");
  write_text(folder / "same_id.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,200\n1,0,0,205,200\n");
  write_text(folder / "negative.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,-200\n");
  write_text(folder / "overlap.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,200\n2,0,0,20,200\n");
  write_text(folder / "metres.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,2e-4\n2,0,0,2.05e-4,2e-4\n");
  write_text(folder / "nan.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,nan,0,200\n");
  write_text(folder / "column.csv", "bead_id,x_um,y_um,diameter_um\n1,0,0,200\n");
  write_text(folder / "measured.toml",
             test::small_sample("max_strain = 0.02\nframes = 2\n", "[beads]\ndiameters = \"measured\"\n"));
  write_text(folder / "unknown.toml", "[beads]\ndiameters = \"exact\"\n");
  write_text(folder / "stated.csv", std::string(kStated) + "1,0,0,0,200,0.1,0.1\n2,0,0,205,200,0.1,0.1\n");
  write_text(folder / "beyond.csv", std::string(kStated) + "1,0,0,0,200,0.1,0.1\n2,0,0,180,200,0.1,0.1\n");
  write_text(folder / "deep.csv", "bead_id,x_um,y_um,z_um,diameter_um\n1,0,0,0,200\n2,0,0,180,200\n");
  write_text(folder / "detached.csv", std::string(kTwoBeads) + "3,0,0,1000,200\n4,0,0,1205,200\n");
  write_text(folder / "missing_bead.csv", "bead_i,bead_j,gap_um,state\n1,7,5,bridge\n");
  write_text(folder / "no_stiffness.toml",
             "[bridges]\nnormal_stiffness_n_per_m = 0\ntangential_stiffness_n_per_m = 325\n");
  write_text(folder / "large_step.toml", "[contact]\ntime_step_fraction = 0.9\n");
  write_text(folder / "no_ramp.toml", "[compression]\ncontrol = \"stress\"\n");
  write_text(folder / "noise.mha", "this is no volume");
  write_text(folder / "file", "a file");
  const auto& bad = GetParam();
  const Outcome outcome = shell(folder.path(), bad.command);
  EXPECT_EQ(outcome.status, bad.status) << outcome.errors;
  EXPECT_NE(outcome.errors.find(bad.expected), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  for (const char* name : {"out.vtp", "out.csv", "out.mha", "out/result.json"})
    EXPECT_FALSE(fs::exists(folder / name)) << name << " is left under its final name";
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadInput,
    testing::Values(
        BadCommand{"UnknownCommand", "$P melt", 2, "melt"},
        BadCommand{"UnknownOption", "$P pack two.csv --sample s.toml -o out.vtp --fast", 2, "--fast"},
        BadCommand{"NoOut", "$P pack two.csv --sample s.toml", 2, "--out"},
        BadCommand{"MissingSample", "$P phantom absent.toml -o out.mha", 3, "absent.toml"},
        BadCommand{"UnknownKey", "$P phantom typo.toml -o out.mha", 3, "beads.diameter_um"},
        BadCommand{"NotAVolume", "$P segment noise.mha -o out.csv", 3, "noise.mha"},
        BadCommand{"MissingVolume", "$P segment absent.mha -o out.csv", 3, "absent.mha"},
        BadCommand{"DuplicateId", "$P pack same_id.csv --sample s.toml -o out.vtp", 3, "same_id.csv"},
        BadCommand{"NegativeDiameter", "$P pack negative.csv --sample s.toml -o out.vtp", 3,
                   "negative.csv:2"},
        BadCommand{"GrossOverlap", "$P pack overlap.csv --sample s.toml -o out.vtp", 3, "overlap.csv"},
        BadCommand{"WrongUnit", "$P pack metres.csv --sample s.toml -o out.vtp", 3, "unit"},
        BadCommand{"Nan", "$P pack nan.csv --sample s.toml -o out.vtp", 3, "nan.csv:2"},
        BadCommand{"MissingColumn", "$P pack column.csv --sample s.toml -o out.vtp", 3, "z_um"},
        BadCommand{"OneBead",
                   "$P pack one.csv --sample s.toml -o one.vtp --quiet && $P compress one.vtp --sample "
                   "s.toml -o out",
                   3, "found 1 bead"},
        BadCommand{"HalfAStiffness", "$P pack two.csv --sample half_stiffness.toml -o out.vtp", 3,
                   "tangential_stiffness_n_per_m: expected both or neither"},
        BadCommand{"StiffnessStatedAndPerBridge", "$P pack two.csv --sample two_stiffnesses.toml -o out.vtp",
                   3, "per_bridge"},
        BadCommand{"UnknownUseOfDiameters", "$P pack two.csv --sample unknown.toml -o out.vtp", 3,
                   "beads.diameters: found \"exact\", expected one of \"auto\", \"measured\", \"drawn\""},
        BadCommand{"RealisationsOfAMeasuredPacking",
                   "$P pack stated.csv --sample s.toml -o stated.vtp --quiet && $P compress stated.vtp "
                   "--sample s.toml -o out --realisations 2",
                   2, "all realisations would be the same"},
        BadCommand{"OverlapBeyondErrors", "$P pack beyond.csv --sample s.toml -o out.vtp", 3,
                   "beyond.csv: beads 1 and 2: found an overlap of 20 um"},
        BadCommand{"DeepOverlap",
                   "$P pack deep.csv --sample measured.toml -o deep.vtp --quiet && $P compress deep.vtp "
                   "--sample measured.toml -o out",
                   3, "beads 1 and 2: found an overlap of 20 um, expected at most 10 um"},
        BadCommand{"Detached",
                   "$P pack detached.csv --sample measured.toml -o detached.vtp --quiet && $P compress "
                   "detached.vtp --sample measured.toml -o out",
                   3, "no network of bonds and touching beads joins the platens"},
        BadCommand{"BridgeToAMissingBead",
                   "$P pack two.csv --bridges missing_bead.csv --sample s.toml -o out.vtp", 3,
                   "missing_bead.csv"},
        BadCommand{"NoStiffness", "$P pack two.csv --sample no_stiffness.toml -o out.vtp", 3,
                   "normal_stiffness_n_per_m"},
        BadCommand{"LargeTimeStep", "$P pack two.csv --sample large_step.toml -o out.vtp", 3,
                   "time_step_fraction: found 0.9"},
        BadCommand{"StressControlWithoutRamp", "$P pack two.csv --sample no_ramp.toml -o out.vtp", 3,
                   "stress_rate_pa_s"},
        BadCommand{"FullDiscOfACompression",
                   "$P pack --generate --sample s.toml -o p.vtp --quiet && (ulimit -f 200; $P compress p.vtp "
                   "--sample s.toml -o out --quiet)",
                   4, "checkpoint.next"},
        BadCommand{"NotAPacking", "$P compress two.csv --sample s.toml -o out", 3, "two.csv"},
        BadCommand{"FolderIsAFile",
                   "$P pack two.csv --sample s.toml -o two.vtp --quiet && $P compress two.vtp --sample "
                   "s.toml -o file",
                   3, "file"},
        BadCommand{"MissingFolder", "$P pack two.csv --sample s.toml -o absent/out.vtp", 3, "absent/out.vtp"},
        BadCommand{"MissingFolderOfBeads", "$P segment noise.mha -o absent/out.csv", 3, "absent/out.csv"},
        BadCommand{"FullDisc", "ulimit -f 64; $P phantom s.toml -o out.mha --quiet", 4, "out.mha"},
        BadCommand{"NoRun", "$P render absent", 3, "absent"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular
