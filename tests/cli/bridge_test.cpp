#include <gtest/gtest.h>

#include <algorithm>

#include "base/csv.h"
#include "base/files.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::Outcome;
using test::ScratchFolder;
using test::shell;

TEST(Bridge, WritesTheConvergedValues) {
  ScratchFolder folder;
  const Outcome outcome =
      shell(folder.path(), "$P bridge --d-um 73.9 --gap-um 2 --D-um 200.9 --E-pa 1.5e6 --nu 0.49 -o out.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string text = read_text(folder / "out.csv");
  EXPECT_NE(text.find("# command: pendular bridge --d-um 73.9"), std::string::npos);
  const CsvTable table = read_csv(folder / "out.csv", {"kn_n_per_m", "kt_n_per_m", "error_estimate"});
  ASSERT_EQ(table.rows(), 1u);
  EXPECT_NEAR(table.numbers("kn_n_per_m")[0], 5517.384, 0.05);
  EXPECT_NEAR(table.numbers("kt_n_per_m")[0], 318.853, 0.003);
  EXPECT_LT(table.numbers("error_estimate")[0], 1e-3);
}

TEST(Bridge, TakesRangesListsAndASample) {
  ScratchFolder folder;
  write_text(folder / "s.toml",
             test::sample_file("[beads]\ndiameter_um = 365\n[bridges]\nyoungs_modulus_pa = 5e4\n"));
  const Outcome outcome = shell(folder.path(), "$P bridge s.toml --d-um 50:70:3 --gap-um 1,2 -o out.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const CsvTable table = read_csv(folder / "out.csv", {"d_um", "D_um", "gap_um", "E_pa", "nu", "kn_n_per_m"});
  EXPECT_EQ(table.numbers("d_um"), (std::vector<double>{50, 60, 70, 50, 60, 70}));
  EXPECT_EQ(table.numbers("gap_um"), (std::vector<double>{1, 1, 1, 2, 2, 2}));
  EXPECT_EQ(table.numbers("D_um"), std::vector<double>(6, 365.0));
  EXPECT_EQ(table.numbers("E_pa"), std::vector<double>(6, 5e4));
  const auto kn = table.numbers("kn_n_per_m");
  EXPECT_TRUE(std::is_sorted(kn.begin(), kn.begin() + 3));
  EXPECT_GT(kn[0], kn[3]);
}

TEST(Bridge, SecondBeadMayBeAnother) {
  ScratchFolder folder;
  ASSERT_EQ(shell(folder.path(),
                  "$P bridge --D-um 180 --D2-um 220 -o a.csv && $P bridge --D-um 220 --D2-um 180 -o b.csv")
                .status,
            0);
  const CsvTable a = read_csv(folder / "a.csv", {"kn_n_per_m", "D2_um", "k_coupling_n_per_rad"}),
                 b = read_csv(folder / "b.csv", {"kn_n_per_m", "D2_um", "k_coupling_n_per_rad"});
  EXPECT_EQ(a.numbers("D2_um")[0], 220.0);
  EXPECT_NEAR(a.numbers("kn_n_per_m")[0], b.numbers("kn_n_per_m")[0], 1e-5);
  EXPECT_NEAR(a.numbers("k_coupling_n_per_rad")[0] / b.numbers("k_coupling_n_per_rad")[0], -1.0, 1e-5);
}

TEST(Bridge, PrintsThePapersTableBesideItsOwn) {
  ScratchFolder folder;
  ASSERT_EQ(shell(folder.path(), "$P bridge > table.txt").status, 0);
  const std::string text = read_text(folder / "table.txt");
  for (const char* word :
       {"Sample A", "Sample B", "5760", "5517.4", "-4.2 %", "325", "318.9", "131", "133.2", "+1.7 %"})
    EXPECT_NE(text.find(word), std::string::npos) << word << " in\n" << text;
}

TEST(Bridge, DrawsThePapersFigureTheSameForAnyNumberOfThreads) {
  ScratchFolder folder;
  ASSERT_EQ(shell(folder.path(),
                  "$P bridge --paper -o a.csv --plot a.png --threads 1 && $P bridge --paper -o b.csv --plot "
                  "b.png --threads 2")
                .status,
            0);
  EXPECT_EQ(read_text(folder / "a.csv"), read_text(folder / "b.csv"));
  EXPECT_EQ(sha256_of(folder / "a.png"), sha256_of(folder / "b.png"));
  const CsvTable table = read_csv(folder / "a.csv", {"d_um", "kn_n_per_m", "kt_n_per_m"});
  const auto d = table.numbers("d_um"), kn = table.numbers("kn_n_per_m"), kt = table.numbers("kt_n_per_m");
  EXPECT_EQ(*std::min_element(d.begin(), d.end()), 50.0);
  EXPECT_EQ(*std::max_element(d.begin(), d.end()), 270.0);
  for (std::size_t k = 0; k < d.size(); ++k) {
    EXPECT_GT(kn[k], 200.0) << "the paper measured 200 to 800 N/m";
    EXPECT_LT(kn[k], 900.0);
    EXPECT_GT(kt[k], 5.0) << "the paper measured 5 to 30 N/m";
    EXPECT_LT(kt[k], 45.0);
  }
}

TEST(Bridge, DrawsWithoutAnXServer) {
  ScratchFolder folder;
  const Outcome outcome =
      shell(folder.path(),
            "mkdir bin && ln -s $(command -v gnuplot) bin/gnuplot && "
            "env -u DISPLAY PATH=$PWD/bin $P bridge --d-um 50,60 --plot a.svg -o a.csv && "
            "rm bin/gnuplot && env -u DISPLAY PATH=$PWD/bin $P bridge --d-um 50,60 --plot b.pdf");
  EXPECT_NE(read_text(folder / "a.svg").find("bridge diameter d"), std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.status, 4) << "without gnuplot";
  EXPECT_NE(outcome.errors.find("package gnuplot-nox"), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "b.pdf"));
}

TEST(Bridge, WarnsOutsideTheVerifiedRange) {
  ScratchFolder folder;
  const Outcome outside = shell(folder.path(), "$P bridge --d-um 10,73.9 -o out.csv");
  EXPECT_EQ(outside.status, 0);
  EXPECT_NE(outside.errors.find("1 of 2 bridges lie outside"), std::string::npos) << outside.errors;
  EXPECT_EQ(shell(folder.path(), "$P bridge --d-um 20.09,160.72 --gap-um 0.2009,20.09 --nu 0.499 -o out.csv")
                .errors,
            "");
}

TEST(Bridge, CompressionUsesItWhereTheSampleStatesNoStiffness) {
  ScratchFolder folder;
  std::string sample = test::small_sample("max_strain = 0.001\nframes = 2\n");
  const std::string stated = "normal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n";
  ASSERT_NE(sample.find(stated), std::string::npos);
  sample.erase(sample.find(stated), stated.size());
  write_text(folder / "s.toml", sample);
  const Outcome outcome =
      shell(folder.path(),
            "$P pack --generate --sample s.toml -o p.vtp --quiet && $P compress p.vtp --sample "
            "s.toml -o run --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(folder / "run" / "result.json"));
}

struct BadBridge {
  const char* name;
  const char* options;
  int status;
  const char* expected;
};

class BadBridgeCommand : public testing::TestWithParam<BadBridge> {};

TEST_P(BadBridgeCommand, GivesOneLineAndTheRightStatus) {
  ScratchFolder folder;
  write_text(folder / "typo.toml", "[bridges]\ndiametr_um = 70\n");
  const Outcome outcome = shell(folder.path(), std::string("$P bridge -o out.csv ") + GetParam().options);
  EXPECT_EQ(outcome.status, GetParam().status) << outcome.errors;
  EXPECT_NE(outcome.errors.find(GetParam().expected), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadBridgeCommand,
    testing::Values(
        BadBridge{"WiderThanBead", "--d-um 210", 3, "210"}, BadBridge{"NegativeGap", "--gap-um -1", 3, "-1"},
        BadBridge{"Touching", "--gap-um 0", 3, "gap"}, BadBridge{"Incompressible", "--nu 0.5", 3, "0.5"},
        BadBridge{"NotANumber", "--d-um wide", 3, "wide"}, BadBridge{"Nan", "--d-um nan", 3, "nan"},
        BadBridge{"FallingRange", "--d-um 50:10:4", 3, "50:10:4"},
        BadBridge{"RangeOfOne", "--d-um 10:50:1", 3, "10:50:1"},
        BadBridge{"EmptyItem", "--d-um 1,,2", 3, "1,,2"},
        BadBridge{"EndlessRange", "--gap-um 1:2:1e12", 3, "expected a number from -1e+06 to 1e+06"},
        BadBridge{"TooMany", "--gap-um 1:2:10000 --d-um 50:60:10000", 3, "combinations"},
        BadBridge{"SoftToNothing", "--E-pa 0", 3, "Young"},
        BadBridge{"MissingSample", "absent.toml", 3, "absent.toml"},
        BadBridge{"UnknownKey", "typo.toml", 3, "bridges.diameter_um"},
        BadBridge{"PaperAndValues", "--paper --nu 0.3", 2, "--paper"},
        BadBridge{"PlotOfOnePoint", "--d-um 50 --plot a.png", 3, "--plot"},
        BadBridge{"PlotOfNoFormat", "--plot a.gif", 2, "a.gif"},
        BadBridge{"NoFolder", "--plot absent/a.png", 3, "absent"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular
