#include "blind/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "blind/mechanism.h"
#include "effects/list.h"
#include "places.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

Split sealed_split() {
  return read_split(fs::path(pendular::test::source_folder()) / "samples/blind/sealed.toml", std::nullopt);
}

}  // namespace

TEST(Plan, SealedSplitIsLargeEnoughAndHasEveryEffectAndMechanism) {
  const auto plans = plan_of(sealed_split());
  std::map<Stratum, int> strata;
  std::set<std::size_t> packings;
  std::set<std::string> effects, mechanisms, names, salts;
  for (const auto& plan : plans) {
    ++strata[plan.stratum];
    packings.insert(plan.packing);
    names.insert(plan.name), salts.insert(plan.salt);
    for (const auto& [id, theta] : plan.effects) effects.insert(id);
    if (!plan.mechanism.empty()) mechanisms.insert(plan.mechanism);
  }
  EXPECT_GE(plans.size(), 80u);
  EXPECT_GE(packings.size(), 4u);
  EXPECT_EQ(names.size(), plans.size());
  EXPECT_EQ(salts.size(), plans.size());
  EXPECT_FALSE(strata.contains(Stratum::other_engine));  // the last one, which no split need have
  for (std::size_t k = 0; k + 1 < kStrata; ++k) EXPECT_GE(strata[static_cast<Stratum>(k)], 7);
  EXPECT_EQ(effects.size(), effects::all_effects().size() - 1);  // no polymer is above W*
  EXPECT_FALSE(effects.contains("funicular_bridges"));
  EXPECT_EQ(mechanisms.size(), all_mechanisms().size());
}

TEST(Plan, ASplitWithoutOtherEnginesStaysAsItWas) {
  // Of the sealed split as it was scored, docs/blind.md.
  const auto plans = plan_of(sealed_split());
  EXPECT_EQ(plans[2].mechanism, "soft_contacts");
  EXPECT_EQ(right_answer(plans[16]), "platen_friction");
  EXPECT_EQ(right_answer(plans[27]), "bridge_bending+platen_friction");
  EXPECT_EQ(right_answer(plans[82]), "interface_strength");
  for (const auto& plan : plans) EXPECT_TRUE(plan.engine.empty());
}

TEST(Plan, CasesShareOutWhatIsObserved) {
  Split split = sealed_split();
  split.cases = 400;
  split.observed = {0.0, 0.0, 0.25, 0.75};
  std::map<Observed, int> observed;
  for (const auto& plan : plan_of(split)) ++observed[plan.observed];
  EXPECT_EQ(observed.size(), 2u);
  EXPECT_NEAR(observed[Observed::second_specimen], 100, 26);  // three standard deviations
}

TEST(Plan, EnginesTakeTurnsAndAThirdOfTheirCasesHasNoEffect) {
  Split split = sealed_split();
  split.cases = 100;
  split.shares = {};
  split.shares[static_cast<std::size_t>(Stratum::other_engine)] = 0.18;
  split.shares[static_cast<std::size_t>(Stratum::none)] = 0.82;
  split.engines = {"yade", "yade_limits", "one_spring"};
  std::map<std::string, int> engines;
  int without = 0;
  for (const auto& plan : plan_of(split)) {
    EXPECT_EQ(plan.engine.empty(), plan.stratum != Stratum::other_engine);
    if (plan.engine.empty()) continue;
    ++engines[plan.engine];
    without += plan.effects.empty();
    EXPECT_LE(plan.effects.size(), 1u);
    EXPECT_EQ(plan.law, "paper");
  }
  EXPECT_EQ(engines, (std::map<std::string, int>{{"yade", 6}, {"yade_limits", 6}, {"one_spring", 6}}));
  EXPECT_EQ(without, 6);
}

TEST(Plan, MagnitudesLieInTheUpperPartOfTheirRanges) {
  for (const auto& plan : plan_of(sealed_split()))
    for (const auto& [id, theta] : plan.effects) {
      const auto& effect = effects::find_effect(id, "test");
      const double share =
          theta > 0.0 ? (theta - std::max(0.0, effect.bank_from)) / effect.bank_to : theta / effect.bank_from;
      EXPECT_GE(share, 0.2) << id;
      EXPECT_LE(share, 1.0) << id;
    }
}

TEST(Plan, MagnitudesGoFromWhereTheyAreSeenAndATenthIsHidden) {
  Split split = sealed_split();
  split.cases = 2000;
  split.seen_from = {{"platen_friction", 0.13}, {"voxel_scale", 0.03}};
  int seen = 0, hidden = 0;
  for (const auto& plan : plan_of(split)) {
    EXPECT_TRUE(!plan.hidden || plan.effects.size() == 1);
    for (const auto& [id, theta] : plan.effects) {
      const auto from = split.seen_from.find(id);
      if (from == split.seen_from.end()) {
        EXPECT_FALSE(plan.hidden) << id;
        continue;
      }
      EXPECT_EQ(std::fabs(theta) < from->second, plan.hidden) << id << " " << theta;
      EXPECT_LE(theta, effects::find_effect(id, "test").bank_to);
      if (plan.effects.size() == 1) ++(plan.hidden ? hidden : seen);
    }
  }
  EXPECT_NEAR(hidden, 0.1 * (seen + hidden), 4.0 * std::sqrt(0.09 * (seen + hidden)));
}

TEST(Plan, ObservationsGoFromACurveAloneToScansUnderLoad) {
  Split split = sealed_split();
  split.cases = 2000;
  const double n = 2000.0;
  std::map<std::string, double> share;
  for (const auto& plan : plan_of(split)) {
    share["alone"] += plan.kinds.empty() / n;
    share["second"] += plan.short_specimen() / n;
    share["scanned"] += plan.scanned() / n;
    share["rest"] += plan.bridges_at_rest / n;
    share["load"] += plan.bridges_under_load / n;
    // Each level has what the one before it has.
    EXPECT_LE(plan.scanned(), plan.short_specimen());
    EXPECT_LE(plan.bridges_under_load, plan.bridges_at_rest);
    EXPECT_LE(plan.bridges_at_rest, plan.scanned());
    if (!plan.kinds.empty()) {
      EXPECT_EQ(plan.kinds[0], "coordination");
      EXPECT_EQ(plan.kinds[1], "lateral_strain");
    }
  }
  // Within four standard errors.
  for (const auto& [what, expected] :
       {std::pair("alone", 0.15), {"second", 0.65}, {"scanned", 0.40}, {"rest", 0.20}, {"load", 0.10}})
    EXPECT_NEAR(share[what], expected, 4.0 * std::sqrt(expected * (1.0 - expected) / n)) << what;
}

TEST(Plan, NamesTellNothingOfTheStratum) {
  const auto plans = plan_of(sealed_split());
  int changes = 0;
  for (std::size_t k = 1; k < plans.size(); ++k) changes += plans[k].stratum != plans[k - 1].stratum;
  EXPECT_GT(changes, 40);  // in order of the strata there would be five
}

TEST(Plan, IsAFunctionOfTheSplitAndItsSeed) {
  Split split = sealed_split();
  const auto plans = plan_of(split), again = plan_of(split);
  split.seed += 1;
  const auto other = plan_of(split);
  std::size_t alike = 0;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    EXPECT_EQ(plans[k].effects, again[k].effects);
    EXPECT_EQ(plans[k].offsets, again[k].offsets);
    EXPECT_EQ(plans[k].salt, again[k].salt);
    alike += plans[k].salt == other[k].salt || right_answer(plans[k]) == right_answer(other[k]);
  }
  EXPECT_LT(alike, plans.size() / 2);
}

TEST(Plan, WrongBeliefsAreOffByTwoSigmas) {
  for (const auto& plan : plan_of(sealed_split())) {
    double farthest = 0.0;
    for (const auto& [key, offset] : plan.offsets) farthest = std::max(farthest, std::fabs(offset));
    EXPECT_LE(farthest, 2.0);
    if (plan.stratum == Stratum::wrong_belief) {
      EXPECT_DOUBLE_EQ(farthest, 2.0);
    }
  }
}

TEST(Plan, AnAddedEffectIsDrawnButNotForAProgramThatLacksIt) {
  const effects::AddedEffect added({.id = "toy_effect",
                                    .unit = "1",
                                    .name = "toy",
                                    .sentence = "A toy.",
                                    .meaning = "of a toy",
                                    .lowest = 0.0,
                                    .highest = 1.0,
                                    .bank_from = 0.0,
                                    .bank_to = 1.0,
                                    .sample = [](Sample&, double) {}});
  Split split = sealed_split();
  split.engines = {"yade", "one_spring"};
  split.cases = 400;
  split.shares = {};
  split.shares[static_cast<std::size_t>(Stratum::other_engine)] = 0.5;
  split.shares[static_cast<std::size_t>(Stratum::library)] = 0.5;
  std::set<std::string> engines;  // of cases with the effect
  for (const auto& plan : plan_of(split))
    if (plan.effects.contains("toy_effect")) {
      engines.insert(plan.engine);
      EXPECT_EQ(right_answer(plan), "toy_effect");
    }
  EXPECT_EQ(engines, (std::set<std::string>{"", "one_spring"}));
}

TEST(Plan, TheRightAnswerOfAPairIsInTheLibrarysOrder) {
  CasePlan plan;
  EXPECT_EQ(right_answer(plan), "none");
  plan.effects = {{"bead_friction", 0.2}};
  EXPECT_EQ(right_answer(plan), "bead_friction");
  plan.effects = {{"bead_friction", 0.2}, {"missing_bridges", 0.1}};
  EXPECT_EQ(right_answer(plan), "missing_bridges+bead_friction");
  plan.effects.clear();
  plan.mechanism = "crack";
  EXPECT_EQ(right_answer(plan), "unknown");
}

}  // namespace pendular::blind
