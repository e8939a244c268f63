#include "tests.h"

#include "base/error.h"
#include "effects/list.h"

namespace pendular::effects::test {
namespace {

/// An effect that no list names: beads rub less by θ.
Effect polish() {
  return {.id = "toy_polish",
          .unit = "1",
          .name = "toy of polished beads",
          .sentence = "Beads rub less than stated.",
          .meaning = "by how much the friction coefficient is lower",
          .lowest = 0.0,
          .highest = 0.5,
          .bank_from = 0.0,
          .bank_to = 0.4,
          .sample = [](Sample& sample, double theta) { sample.contact.friction -= theta; }};
}

std::string refusal(const Effect& effect) {
  try {
    const AddedEffect added(effect);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(AddedEffect, ActsLikeOneOfTheLibraryAsLongAsItLives) {
  const std::size_t count = all_effects().size();
  {
    const AddedEffect added(polish());
    EXPECT_EQ(all_effects().size(), count + 1);
    EXPECT_EQ(&find_effect("toy_polish", "test"), &added.effect());
    EXPECT_NO_THROW(check_effects(with("toy_polish", 0.2), "s.toml"));
    EXPECT_THROW(check_effects(with("toy_polish", 0.6), "s.toml"), BadInput);
    const Packing packing = pendular::test::disordered(3, 3);
    const double friction = pendular::test::sample_a().contact.friction;
    Sample sample = pendular::test::sample_a();
    sample.effects["toy_polish"] = 0.2;
    EXPECT_EQ(actual_specimen(packing, sample, 1).sample.contact.friction, friction - 0.2);
  }
  EXPECT_EQ(all_effects().size(), count);
  EXPECT_FALSE(known_effect("toy_polish"));
  EXPECT_THROW(check_effects(with("toy_polish", 0.2), "s.toml"), BadInput);
}

TEST(AddedEffect, OthersMayComeAndGoInAnyOrder) {
  auto first = std::make_unique<AddedEffect>(polish());
  Effect other = polish();
  other.id = "toy_other";
  const AddedEffect second(other);
  const Effect* held = known_effect("toy_other");
  first.reset();
  EXPECT_EQ(known_effect("toy_other"), held);
  EXPECT_EQ(held->id, "toy_other");
}

TEST(AddedEffect, WhatCannotBeOneIsRefused) {
  Effect effect = polish();
  effect.id = "missing_bridges";
  EXPECT_EQ(refusal(effect), "effect missing_bridges: there is one of that name");
  effect = polish(), effect.id = "no blanks";
  EXPECT_NE(refusal(effect).find("no blanks"), std::string::npos);
  effect = polish(), effect.sentence.clear();
  EXPECT_NE(refusal(effect).find("toy_polish: expected a unit, a name"), std::string::npos);
  effect = polish(), effect.bank_to = 0.6;
  EXPECT_NE(refusal(effect).find("found 0 to 0.6 within 0 to 0.5"), std::string::npos);
  EXPECT_EQ(refusal(polish()), "");
}

}  // namespace
}  // namespace pendular::effects::test
