#include "base/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "places.h"

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

/// A value other than the one a key has by default.
SampleValue other_value(const std::string& name) {
  static const std::map<std::string, SampleValue> special = {
      {"beads.diameters", "measured"},
      {"bridges.stiffness", "per_bridge"},
      {"bridges.breaking", "limits"},
      {"contact.glass", "hertz"},
      {"contact.tangential_springs", "one"},
      {"compression.control", "stress"},
      {"compression.unload_at", std::vector{0.01, 0.02}},
      {"compression.hold_at", std::vector{0.03}},
      {"compression.frame_at", std::vector{0.02}},
      {"contact.bond_friction_limit", false}};
  const auto found = special.find(name);
  if (found != special.end()) return found->second;
  if (name.starts_with("observe.")) return false;
  for (const auto& key : sample_keys())
    if (key.name == name) return std::isfinite(key.highest) ? 0.3 * key.lowest + 0.7 * key.highest : 1234.5;
  ADD_FAILURE() << "no value for " << name;
  return 0.0;
}

TEST(Sample, ItsTextTellsEveryKey) {
  const std::string before = sample_text(Sample{});
  for (const auto& name : sample_key_names()) {
    if (name == "specimen.shape") continue;  // has one value
    Sample sample;
    set_sample_key(sample, name, other_value(name), "test");
    EXPECT_NE(sample_text(sample), before) << name;
  }
}

TEST(Sample, ItsTextReadsBackBitForBit) {
  const auto root = fs::path(pendular::test::source_folder()) / "samples";
  for (const char* name : {"hemmerle2021_a", "hemmerle2021_b", "demo"})
    for (int round = 0; round < 50; ++round) {
      Sample sample = read_sample(root / (std::string(name) + ".toml"));
      sample.compression.unload_at = {0.01, 1.0 / 30.0};
      std::uint64_t draw = 0;
      for (const auto& key : sample_keys()) {
        if (key.name == "phantom.bits" || key.name == "compression.stress_rate_pa_s" || draw++ % 3 == 0)
          continue;
        if (key.name == "bridges.diameter_um" || !std::isfinite(key.highest)) continue;
        const double u = random_uniform(static_cast<std::uint64_t>(round), draw);
        set_sample_key(sample, key.name, key.lowest + u * (key.highest - key.lowest));
      }
      set_sample_key(sample, "beads.diameter_um", 150.0 + 100.0 * random_uniform(3, round));
      const Sample again = parse_sample(sample_text(sample), "again");
      EXPECT_EQ(sample_text(again), sample_text(sample));
      EXPECT_EQ(sample_text(parse_sample("", "again", sample_settings(sample))), sample_text(sample));
      for (const auto& key : sample_keys()) {
        if (key.name.find("stiffness_n_per_m") != std::string::npos || !std::isfinite(key.highest)) continue;
        if (key.name == "compression.speed_mm_s" || key.name == "compression.hold_s" ||
            key.name == "compression.stress_rate_pa_s" || key.name == "compression.max_stress_pa" ||
            key.name == "bridges.relaxation_time_s")
          continue;
        EXPECT_EQ(sample_key(again, key.name), sample_key(sample, key.name)) << key.name;
      }
      EXPECT_EQ(again.compression.unload_at, sample.compression.unload_at);
    }
}

TEST(Sample, ItsTextSettlesForNumbersThatNoTextMakes) {
  for (std::uint64_t round = 0; round < 2000; ++round) {
    Sample sample;
    sample.beads.diameter = 1e-4 * (1.5 + random_uniform(5, 2 * round));  // m, not read from micrometres
    sample.specimen.height = 1e-3 * (1.0 + random_uniform(5, 2 * round + 1));
    const Sample again = parse_sample(sample_text(sample), "again");
    EXPECT_NEAR(again.beads.diameter, sample.beads.diameter, 1e-15 * sample.beads.diameter);
    EXPECT_EQ(sample_text(again), sample_text(sample));
  }
}

TEST(Sample, SettingsCountAsIfTheFileHadThem) {
  const std::string text = "[contact]\nfriction = 0.3\n";
  EXPECT_EQ(
      sample_text(parse_sample(text, "s", {{"contact.friction", 0.1}, {"bridges.stiffness", "per_bridge"}})),
      sample_text(parse_sample("[contact]\nfriction = 0.1\n[bridges]\nstiffness = \"per_bridge\"\n", "s")));
  EXPECT_THROW(parse_sample(text, "s", {{"bridges.normal_stiffness_n_per_m", 5.0}}), BadInput);
  EXPECT_THROW(parse_sample(text, "s", {{"contact.friction", "low"}}), BadInput);
}

TEST(Sample, PolymerContentGoesAsTheSquareOfTheNeck) {
  Sample sample;
  set_polymer_content(sample, 4.0 * sample.bridges.polymer_content);
  EXPECT_NEAR(sample.bridges.diameter, 2.0 * Sample{}.bridges.diameter, 1e-15);
  EXPECT_NEAR(sample.bridges.diameter_sd, 2.0 * Sample{}.bridges.diameter_sd, 1e-15);
  EXPECT_DOUBLE_EQ(sample.bridges.polymer_content, 4.0 * Sample{}.bridges.polymer_content);
  EXPECT_THROW(set_polymer_content(sample, -0.01), BadInput);
}

TEST(Sample, TheProjectsOwnSamplesAreValid) {
  for (const char* name : {"hemmerle2021_a", "hemmerle2021_b", "demo"})
    EXPECT_NO_THROW(
        read_sample(fs::path(pendular::test::source_folder()) / "samples" / (std::string(name) + ".toml")))
        << name;
}

/// A file with every line of the text but those that hold `key`.
std::string without(const std::string& key) {
  std::istringstream lines(sample_text(Sample{}));
  std::string text;
  for (std::string line, section; std::getline(lines, line);) {
    if (line.starts_with('[')) section = line.substr(1, line.size() - 2);
    if (section + "." + line.substr(0, line.find(' ')) != key) text += line + "\n";
  }
  return text;
}

TEST(Sample, WhatASpecimenIsHasNoDefault) {
  EXPECT_NO_THROW(whole_sample(without(""), "s.toml"));
  EXPECT_THROW(whole_sample("", "s.toml"), BadInput);
  for (const char* key : {"beads.diameter_um", "beads.density_kg_m3", "bridges.youngs_modulus_pa",
                          "bridges.interfacial_energy_j_m2", "contact.friction", "specimen.height_um",
                          "compression.max_strain"}) {
    try {
      whole_sample(without(key), "s.toml");
      FAIL() << key << " has a default";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
    EXPECT_NO_THROW(whole_sample(without(key), "s.toml", {{key, sample_key(Sample{}, key)}}));
  }
  EXPECT_NO_THROW(whole_sample(without("contact.damping_fraction"), "s.toml"));
}

TEST(Sample, WhatEarlierVersionsLackIsNamed) {
  ::testing::internal::CaptureStderr();
  warn_of_later_keys(without("contact.bond_friction_limit"), "s.toml");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "warning: s.toml: lacks contact.bond_friction_limit, as samples of earlier versions do: taken as "
            "docs/sample.md says\n");
  ::testing::internal::CaptureStderr();
  warn_of_later_keys(without(""), "s.toml");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Sample, AnIntegerBetweenTwoDoublesIsANumber) {
  EXPECT_THROW(parse_sample("[specimen]\nvolume_fraction = 9000000000000000001\n", "s.toml"), BadInput);
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
        BadSample{"CutWord", "[contact]\nbond_friction_limit = fal\n", "saw 'fal '"},
        BadSample{"Word", "[contact]\ntangential_springs = \"three\"\n", "\"one\", \"two\""},
        BadSample{"Glass", "[contact]\nglass = \"mindlin\"\n", "\"linear\", \"hertz\""},
        BadSample{"TopLevel", "diameter_um = 3\n", "section"},
        BadSample{"Unload", "[compression]\nunload_at = [0.02, 0.01]\n", "rising"},
        BadSample{"Shape", "[specimen]\nshape = \"cube\"\n", "cylinder"},
        BadSample{"Bits", "[phantom]\nbits = 12\n", "8 or 16"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular
