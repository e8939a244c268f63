#include "diagnosis/experiment/experiment.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "places.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular::diagnosis {
namespace {

using test::ScratchFolder;

constexpr char kCurve[] =
    "strain,stress_pa\n0,0\n0.01,1e5\n0.02,3e5\n0.03,6e5\n0.04,9e5\n0.05,12e5\n0.06,14e5\n0.07,14e5\n";

/// A folder with a good experiment, one file of which may be replaced.
fs::path written(const ScratchFolder& folder, const std::string& file = "", const std::string& text = "") {
  write_text(folder / "sample.toml", pendular::test::sample_file("[bridges]\nyoungs_modulus_pa = 1.5e6\n"));
  write_text(folder / "A.csv", kCurve);
  write_text(folder / "z.csv", "z,z_sigma\n7.1,0.1\n");
  write_text(folder / "e.toml",
             "[experiment]\nname = \"two\"\nsample = \"sample.toml\"\n[uncertainty]\n"
             "\"bridges.youngs_modulus_pa\" = 1.5e5\n[[observation]]\nkind = \"compression\"\nname = \"A\"\n"
             "file = \"A.csv\"\nset = { \"bridges.youngs_modulus_pa\" = 6.4e5 }\n"
             "[[observation]]\nkind = \"coordination\"\nfile = \"z.csv\"\n");
  if (!file.empty()) write_text(folder / file, text);
  return folder / "e.toml";
}

TEST(Experiment, IsRead) {
  ScratchFolder folder;
  const Experiment experiment = read_experiment(written(folder));
  ASSERT_EQ(experiment.observations.size(), 2u);
  EXPECT_EQ(experiment.observations[0].column("stress_pa")[2], 3e5);
  EXPECT_EQ(experiment.observations[1].name, "z");
  EXPECT_EQ(experiment.sample_of(experiment.observations[0]).bridges.youngs_modulus, 6.4e5);
  EXPECT_EQ(experiment.sample_of(experiment.observations[1]).bridges.youngs_modulus, 1.5e6);
  EXPECT_EQ(experiment.uncertainty.at("bridges.youngs_modulus_pa"), 1.5e5);
}

TEST(Experiment, ThePapersOwnGapIsRead) {
  const Experiment gap =
      read_experiment(fs::path(pendular::test::source_folder()) / "samples/hemmerle2021/gap/experiment.toml");
  EXPECT_EQ(gap.observations.size(), 6u);
  EXPECT_TRUE(gap.warnings.empty());
}

TEST(Experiment, UncertaintiesOfZeroCountAsNotGiven) {
  ScratchFolder folder;
  std::string text = "strain,stress_pa,stress_sigma_pa\n";
  for (int k = 0; k < 10; ++k) text += std::to_string(0.01 * k) + "," + std::to_string(1e5 * k) + ",0\n";
  const Experiment experiment = read_experiment(written(folder, "A.csv", text));
  EXPECT_FALSE(experiment.observations[0].has("stress_sigma_pa"));
  ASSERT_EQ(experiment.warnings.size(), 1u);
}

struct Bad {
  const char* name;
  const char* file;
  std::string text, told;  // the message must tell this
};

std::string curve_times(double strain, double stress) {
  std::string text = "strain,stress_pa\n";
  for (int k = 0; k < 10; ++k)
    text += std::to_string(0.008 * k * strain) + "," + std::to_string(1.5e5 * k * stress) + "\n";
  return text;
}

class BadExperiment : public testing::TestWithParam<Bad> {};

TEST_P(BadExperiment, IsToldInOneLine) {
  ScratchFolder folder;
  const fs::path path = written(folder, GetParam().file, GetParam().text);
  try {
    read_experiment(path);
    FAIL() << "expected to be refused";
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(GetParam().told), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

const std::string kHead = "[experiment]\nsample = \"sample.toml\"\n";
const std::string kOne = "[[observation]]\nkind = \"compression\"\nfile = \"A.csv\"\n";

INSTANTIATE_TEST_SUITE_P(
    Table, BadExperiment,
    testing::Values(
        Bad{"PerCent", "A.csv", curve_times(100.0, 1.0), "per cent"},
        Bad{"Megapascals", "A.csv", curve_times(1.0, 1e-6), "MPa"},
        Bad{"MillionTimesTooLarge", "A.csv", curve_times(1.0, 1e6), "times the polymer's"},
        Bad{"Tension", "A.csv", curve_times(1.0, -1.0), "compression positive"},
        Bad{"MissingColumn", "A.csv", "strain,stress\n0,0\n", "stress_pa"},
        Bad{"TooFewRows", "A.csv", "strain,stress_pa\n0,0\n0.1,1e5\n", "at least 8"},
        Bad{"NotANumber", "z.csv", "z,z_sigma\nseven,0.1\n", "seven"},
        Bad{"CoordinationOfForty", "z.csv", "z,z_sigma\n40,0.1\n", "0 to 14"},
        Bad{"NegativeSigma", "z.csv", "z,z_sigma\n7,-0.1\n", "expected a number from 0"},
        Bad{"UnknownKind", "e.toml", kHead + "[[observation]]\nkind = \"compresion\"\nfile = \"A.csv\"\n",
            "\"compression\""},
        Bad{"UnknownKey", "e.toml", kHead + kOne + "fiel = 3\n", "observation.file"},
        Bad{"UnknownSetting", "e.toml", kHead + kOne + "set = { \"bridges.gap\" = 1 }\n", "bridges.gap_um"},
        Bad{"UnknownUncertainty", "e.toml", kHead + "[uncertainty]\n\"bridges.gap\" = 1\n" + kOne,
            "bridges.gap_um"},
        Bad{"NoObservation", "e.toml", kHead, "observation"},
        Bad{"NoSample", "e.toml", "[experiment]\nname = \"x\"\n" + kOne, "sample"},
        Bad{"AbsentFile", "e.toml", kHead + "[[observation]]\nkind = \"compression\"\nfile = \"B.csv\"\n",
            "B.csv"},
        Bad{"SameNameTwice", "e.toml", kHead + kOne + kOne, "\"A\""},
        Bad{"UnknownWordOfAKind", "e.toml",
            kHead + "[[observation]]\nkind = \"broken_bonds\"\nfile = \"A.csv\"\ncounts = \"rate\"\n",
            "per_interval"},
        Bad{"KeyOfAnotherKind", "e.toml", kHead + kOne + "counts = \"total\"\n", "observation.counts"},
        Bad{"SeriesWithoutAbscissa", "e.toml",
            kHead + "[[observation]]\nkind = \"modulus_series\"\nfile = \"m.csv\"\n", "m.csv"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular::diagnosis
