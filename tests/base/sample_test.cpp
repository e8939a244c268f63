#include "base/sample.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace pendular {
namespace {

TEST(Sample, ReadsUnitsIntoSi) {
  const Sample sample = parse_sample(
      "[beads]\ndiameter_um = 365\n[bridges]\nyoungs_modulus_pa = 5e4\n[compression]\nspeed_mm_s = 2.5\n"
      "unload_at = [0.01, 0.02]\n[contact]\nfriction = 0.3\n",
      "s.toml");
  EXPECT_DOUBLE_EQ(sample.beads.diameter, 365e-6);
  EXPECT_DOUBLE_EQ(sample.bridges.youngs_modulus, 5e4);
  EXPECT_DOUBLE_EQ(sample.compression.speed_si.value(), 2.5e-3);
  EXPECT_EQ(sample.compression.unload_at, (std::vector<double>{0.01, 0.02}));
  EXPECT_DOUBLE_EQ(sample.contact.platen_friction, 0.3)
      << "a platen is like another bead unless said otherwise";
}

TEST(Sample, EveryNumericKeyCanBeSetAndReadBack) {
  for (const auto& key : sample_keys()) {
    Sample sample;
    const double value = std::isfinite(key.highest) ? 0.5 * (key.lowest + key.highest) : 1234.5;
    set_sample_key(sample, key.name, value);
    EXPECT_NEAR(sample_key(sample, key.name), value, 1e-12 * value) << key.name;
  }
}

TEST(Sample, TheProjectsOwnSamplesAreValid) {
  for (const char* name : {"hemmerle2021_a", "hemmerle2021_b", "demo"})
    EXPECT_NO_THROW(read_sample(fs::path(PENDULAR_SOURCE_DIR) / "samples" / (std::string(name) + ".toml")))
        << name;
}

struct BadSample {
  const char* name;
  const char* text;
  const char* expected;
};

class SampleBadInput : public testing::TestWithParam<BadSample> {};

TEST_P(SampleBadInput, NamesFileLineKeyAndExpectation) {
  try {
    parse_sample(GetParam().text, "s.toml");
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
    EXPECT_NE(message.find("s.toml"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, SampleBadInput,
    testing::Values(
        BadSample{"UnknownKey", "[beads]\ndiametr_um = 3\n",
                  "s.toml:2: beads.diametr_um: unknown key, the nearest known one is \"beads.diameter_um\""},
        BadSample{"UnknownSection", "[bead]\ndiameter_um = 3\n",
                  "nearest known one is \"beads.diameter_um\""},
        BadSample{"WrongUnit", "[bridges]\nyoungs_modulus_mpa = 1.5\n", "bridges.youngs_modulus_pa"},
        BadSample{"NotANumber", "[beads]\ndiameter_um = \"200\"\n", "found a string, expected a number"},
        BadSample{"Nan", "[beads]\ndiameter_um = nan\n", "finite"},
        BadSample{"Negative", "[beads]\ndiameter_um = -1\n", "expected a number from"},
        BadSample{"PoissonHalf", "[bridges]\npoisson_ratio = 0.5\n", "bridges.poisson_ratio"},
        BadSample{"NeckLargerThanBead", "[bridges]\ndiameter_um = 300\n", "bridges.diameter_um"},
        BadSample{"OneStiffness", "[bridges]\nnormal_stiffness_n_per_m = 5760\n", "both or neither"},
        BadSample{"Syntax", "[beads\n", "s.toml:1"},
        BadSample{"Word", "[contact]\ntangential_springs = \"three\"\n", "\"one\", \"two\""},
        BadSample{"TopLevel", "diameter_um = 3\n", "section"},
        BadSample{"Unload", "[compression]\nunload_at = [0.02, 0.01]\n", "rising"},
        BadSample{"Shape", "[specimen]\nshape = \"cube\"\n", "cylinder"},
        BadSample{"Bits", "[phantom]\nbits = 12\n", "8 or 16"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular
