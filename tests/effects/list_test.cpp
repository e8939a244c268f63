#include "tests.h"

#include <cctype>
#include <set>

#include "base/error.h"
#include "effects/list.h"

namespace pendular::effects::test {
namespace {

TEST(Effects, HaveTheirIdsAndUsableRanges) {
  std::set<std::string> ids;
  for (const auto& effect : all_effects()) {
    EXPECT_TRUE(ids.insert(effect.id).second) << effect.id;
    EXPECT_LE(effect.lowest, effect.bank_from) << effect.id;
    EXPECT_LE(effect.bank_from, 0.0) << effect.id;
    EXPECT_GT(effect.bank_to, 0.0) << effect.id;
    EXPECT_LE(effect.bank_to, effect.highest) << effect.id;
  }
  EXPECT_EQ(ids, (std::set<std::string>{"bridge_gap_spread", "bridge_diameter_spread", "missing_bridges",
                                        "bridge_bending", "polymer_nonlinearity", "polymer_viscoelasticity",
                                        "bond_damage", "interface_strength", "residual_stress",
                                        "bead_friction", "platen_friction", "platen_tilt", "platen_roughness",
                                        "machine_compliance", "funicular_bridges", "position_error",
                                        "diameter_bias", "voxel_scale", "loading_rate"}));
}

TEST(Effects, HaveAPlainNameAndASentenceOfTheirOwn) {
  std::set<std::string> names, sentences;
  for (const auto& effect : all_effects()) {
    EXPECT_TRUE(names.insert(effect.name).second) << effect.id;
    EXPECT_TRUE(sentences.insert(effect.sentence).second) << effect.id;
    EXPECT_GE(effect.name.size(), 10u) << effect.id;
    EXPECT_LE(effect.name.size(), 40u) << effect.id;
    EXPECT_EQ(effect.name.find('_'), std::string::npos) << effect.id;
    EXPECT_TRUE(std::islower(static_cast<unsigned char>(effect.name.front()))) << effect.id;
    EXPECT_GE(effect.sentence.size(), 30u) << effect.id;
    EXPECT_LE(effect.sentence.size(), 100u) << effect.id;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(effect.sentence.front()))) << effect.id;
    EXPECT_EQ(effect.sentence.find('.'), effect.sentence.size() - 1) << effect.id;  // one sentence
  }
}

TEST(Effects, AreReadFromASampleAndWrittenBack) {
  const Sample sample = parse_sample("[effects]\nmissing_bridges = 0.1\nplaten_tilt = 0\n", "s.toml");
  EXPECT_EQ(sample.effects, (std::map<std::string, double>{{"missing_bridges", 0.1}}));
  EXPECT_EQ(parse_sample(sample_text(sample), "again").effects, sample.effects);
  EXPECT_EQ(sample_key(sample, "effects.missing_bridges"), 0.1);
  EXPECT_THROW(parse_sample("[effects]\n\"a b\" = 1\n", "s.toml"), BadInput);
  EXPECT_THROW(parse_sample("[effects]\nmissing_bridges = \"many\"\n", "s.toml"), BadInput);
}

std::string complaint(const std::string& effect, double theta) {
  try {
    check_effects(with(effect, theta), "s.toml");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Effects, UnknownOnesAndMagnitudesOutOfRangeAreNamed) {
  EXPECT_EQ(complaint("missing_bridges", 0.1), "");
  EXPECT_EQ(complaint("missing_bridge", 0.1),
            "s.toml: effects.missing_bridge: unknown effect, the nearest known one is \"missing_bridges\"");
  EXPECT_EQ(complaint("missing_bridges", 1.5),
            "s.toml: effects.missing_bridges: found 1.5, expected fraction from 0 to 0.9");
}

}  // namespace
}  // namespace pendular::effects::test
