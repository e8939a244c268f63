#include "diagnosis/words.h"

#include <gtest/gtest.h>

#include "base/quantity.h"
#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/repair/shrinkage.h"
#include "diagnosis/verdict.h"

namespace pendular::diagnosis {
namespace {

Explanation missing(double probability) {
  return {"missing_bridges", probability, {{0.1967, {0.1802, 0.2121}}}, {"fraction"}};
}

Explanation bare(const std::string& id, double probability) {
  return {id, probability, {}, {}};
}

/// One feature that differs, and these explanations, of which the first `in_set` are the set.
Diagnosis told(std::vector<Explanation> explanations, std::size_t in_set) {
  Diagnosis d;
  GapRow row;
  row.observed = {"A", "linear_modulus", Scale::aggregate, true, 1e7};
  row.simulated = 1.93e7, row.difference = 0.6575, row.z = 9.3, row.significant = true, row.share = 1.0;
  d.gap.rows = {row};
  d.explanations = std::move(explanations);
  for (std::size_t k = 0; k < in_set; ++k) {
    d.ambiguity_set.push_back(d.explanations[k].id);
    d.set_probability += d.explanations[k].probability;
  }
  return d;
}

bool says(const Diagnosis& d, const std::string& words) {
  return verdict_of(d).find(words) != std::string::npos;
}

TEST(Words, APairIsNamedByBoth) {
  const Explanation pair{"missing_bridges+bead_friction",
                         0.5,
                         {{0.1967, {0.1802, 0.2121}}, {-0.2041, {-0.2577, -0.1512}}},
                         {"fraction", "1"}};
  EXPECT_EQ(in_words(pair),
            "bridges missing between near beads with bead friction other than stated "
            "(missing_bridges+bead_friction), 20 % (18 to 21 %) and -0.20 (-0.26 to -0.15)");
  EXPECT_EQ(sentence_of(pair.id), sentence_of("missing_bridges") + " " + sentence_of("bead_friction"));
}

TEST(Words, WhatHasNoNameStaysAsItIs) {
  EXPECT_EQ(name_and_id("a+b"), "a with b (a+b)");
  EXPECT_EQ(name_and_id("x"), "x");
  EXPECT_EQ(name_and_id("none"), "no effect (none)");
}

TEST(Words, FeaturesHaveUnits) {
  EXPECT_EQ(in_words(Feature{"A", "toe_strain"}), "toe strain of A");
  EXPECT_EQ(unit_of(Feature{"A", "toe_strain"}), "fraction");
  EXPECT_EQ(unit_of(Feature{"A", "linear_modulus"}), "Pa");
  EXPECT_EQ(unit_of(Feature{"g", "gap_mean_um"}), "um");
  EXPECT_EQ(in_words(Feature{"g", "gap_mean_um"}), "gap mean of g");
  EXPECT_EQ(in_words(Feature{"beads", "contact_variance_um2"}), "contact variance of beads");
  EXPECT_EQ(quantity(0.0264, unit_of(Feature{"beads", "contact_variance_um2"})), "0.0264 µm²");
  EXPECT_EQ(unit_of(Feature{"E", "modulus_exponent"}), "1");
}

TEST(Verdict, BeginsWithTheCauseAndWhatToDoNext) {
  Diagnosis d = told({missing(0.974), bare("none", 0.026)}, 1);
  d.next.now = {.cases = 50, .set_size = 3.2};
  d.next.experiments = {
      {"a second scan under load", "strain shows where it goes", 1.0, {.cases = 50, .set_size = 1.4}}};
  EXPECT_TRUE(
      verdict_of(d).starts_with("The cause is bridges missing between near beads (missing_bridges), 20 % (18 "
                                "to 21 %), probability 97 %. "
                                "Next: a second scan under load – strain shows where it goes; it is expected "
                                "to leave 1.4 explanations of 3.2.\n"))
      << verdict_of(d);
  EXPECT_TRUE(says(d, "the simulation is 1.93 times too stiff in the linear modulus of A (9.3 sigma)"));
  d.next = {};
  EXPECT_TRUE(says(d, "No further measurement is needed."));
}

TEST(Verdict, AMeasurementThatLeavesAsManyIsNotSaidToLeaveFewer) {
  const Outlook now = {.cases = 50, .set_size = 1.04, .settled = 0.60};
  EXPECT_EQ(outlook_in_words({.cases = 50, .set_size = 1.0, .settled = 0.9}, now),
            "leave one explanation in 90 % of such experiments instead of 60 %");
  EXPECT_EQ(outlook_in_words({.cases = 50, .set_size = 1.3, .settled = 0.5}, now),
            "make the right explanation more probable");
}

TEST(Verdict, SaysPlainlyWhenItDoesNotKnow) {
  const Explanation tilt{"platen_tilt", 0.3, {{0.5, {0.2, 0.8}}}, {"degrees"}};
  EXPECT_TRUE(
      says(told({bare("unknown", 0.96), bare("none", 0.04)}, 1), "The cause is not known: no effect"));
  EXPECT_TRUE(
      says(told({bare("unknown", 0.96), bare("none", 0.04)}, 1), "What to measure next cannot be told"));
  EXPECT_TRUE(
      says(told({missing(0.4), tilt, bare("none", 0.3)}, 3), "The cause is not known: 3 explanations"));
  EXPECT_TRUE(says(told({missing(0.7), tilt}, 2), "most probable cause is bridges missing"));
  EXPECT_FALSE(says(told({missing(0.7), tilt}, 2), "not known"));
}

TEST(Verdict, UnknownIsNoGapWhereNoFeatureDiffers) {
  Diagnosis d = told({bare("unknown", 0.78), bare("none", 0.1)}, 2);
  for (auto& row : d.gap.rows) row.significant = false;
  EXPECT_TRUE(verdict_of(d).starts_with("The cause is not known: no feature by itself differs"))
      << verdict_of(d);
  EXPECT_TRUE(says(d, "probability 78 %; not excluded: no effect (none).")) << verdict_of(d);
  EXPECT_FALSE(says(d, "explains the gap")) << verdict_of(d);
}

TEST(Verdict, SaysThatPairsWereNotRunWhereTheyExplainMost) {
  const Diagnosis alone = told({bare(kOtherPairs, 0.8), bare("unknown", 0.2)}, 1);
  EXPECT_TRUE(
      says(alone, "probability 80 %, but no run has both (--runs). What to measure next cannot be told"))
      << verdict_of(alone);
  const Diagnosis beside = told({bare(kOtherPairs, 0.6), bare("none", 0.2)}, 2);
  EXPECT_TRUE(says(beside, "but no run has both (--runs); not excluded: no effect (none)."))
      << verdict_of(beside);
}

TEST(Verdict, WhereUnknownLeadsTheNextThatHasANameIsAdded) {
  const auto added = [](const Diagnosis& d) {
    const Explanation* found = to_add(d);
    return found ? found->id : "";
  };
  EXPECT_EQ(added(told({missing(0.7), bare("none", 0.3)}, 2)), "missing_bridges");
  EXPECT_EQ(added(told({bare("none", 0.6), missing(0.4)}, 2)), "");
  EXPECT_EQ(added(told({bare("unknown", 0.96), missing(0.04)}, 1)), "");  // it is not in the set
  Diagnosis d = told({bare("unknown", 0.6), bare("none", 0.1), missing(0.3)}, 3);
  EXPECT_EQ(added(d), "missing_bridges");
  EXPECT_EQ(added(told({bare(kOtherPairs, 0.6), missing(0.4)}, 2)), "missing_bridges");
  d.fitted.observations = {"A"};
  d.fitted.fraction = 0.8, d.fitted.interval_90 = {0.7, 0.9};
  EXPECT_TRUE(says(d, "Added to the simulation, bridges missing between near beads (missing_bridges) closes"))
      << verdict_of(d);
}

TEST(Verdict, WhereUnknownLeadsAPairThePairIsNamedIfItIsNotUnlikely) {
  const Explanation pair{"missing_bridges+bead_friction",
                         0.3,
                         {{0.1967, {0.1802, 0.2121}}, {-0.2041, {-0.2577, -0.1512}}},
                         {"fraction", "1"}};
  const Diagnosis d = told({bare("unknown", 0.65), pair, missing(0.05)}, 3);
  Explanation hardly = pair;
  hardly.probability = 0.02;
  EXPECT_TRUE(verdict_of(told({bare("unknown", 0.93), hardly, missing(0.01)}, 3))
                  .starts_with("The cause is not known: no effect of the library explains the gap, "
                               "probability 93 %; not excluded: bridges missing between near beads with bead "
                               "friction other than stated (missing_bridges+bead_friction)"));
  EXPECT_TRUE(verdict_of(d).starts_with(
      "The cause is not known: bridges missing between near beads with bead friction other than stated "
      "(missing_bridges+bead_friction), 20 % (18 to 21 %) and -0.20 (-0.26 to -0.15) would explain the gap, "
      "probability 30 %, but where one effect leaves as much the cause is more often outside the library, "
      "65 %; not excluded: bridges missing between near beads "
      "(missing_bridges)."))
      << verdict_of(d);
}

TEST(Verdict, TellsLimitsToTwoDigits) {
  Diagnosis d = told({bare("none", 0.98)}, 1);
  d.unseen = {{"voxel_scale", "fraction", 0.06427}, {"platen_friction", "1", 1.4694}};
  EXPECT_TRUE(
      says(d, "hardly show wrong voxel size up to 6.4 % and platen friction other than stated up to 1.5."))
      << verdict_of(d);
}

TEST(Verdict, NoneIsNotTheEndWhereWhatItStandsForIsInQuestion) {
  Diagnosis d = told({bare("none", 0.9), missing(0.05)}, 1);
  d.unseen = {{"missing_bridges", "fraction", 0.03}};
  EXPECT_TRUE(
      verdict_of(d).starts_with("Experiment and simulation agree: no effect is needed that these "
                                "observations would show, probability 90 %. What to measure next"))
      << verdict_of(d);
  EXPECT_FALSE(is_settled(d));
  EXPECT_TRUE(is_settled(told({bare("none", 0.98), missing(0.01)}, 1)));
  EXPECT_TRUE(is_settled(told({missing(0.9), bare("none", 0.1)}, 1)));
  EXPECT_FALSE(is_settled(told({missing(0.9), bare("none", 0.1)}, 2)));
}

TEST(Verdict, ALoneMemberOfASetThatIsNotLikelyIsNoEnd) {
  const Diagnosis d = told({missing(0.42), bare("platen_tilt", 0.3)}, 1);
  EXPECT_TRUE(verdict_of(d).starts_with("The most probable cause is bridges missing")) << verdict_of(d);
  EXPECT_TRUE(says(d, "but with a probability of 42 % alone. What to measure next")) << verdict_of(d);
  EXPECT_FALSE(is_settled(d));
}

TEST(Verdict, LongSetsAreCutShort) {
  const Diagnosis d = told({missing(0.6), bare("platen_tilt", 0.1), bare("bond_damage", 0.1),
                            bare("none", 0.1), bare("unknown", 0.1)},
                           5);
  EXPECT_TRUE(says(d, "no effect (none) and 1 more")) << verdict_of(d);
}

}  // namespace
}  // namespace pendular::diagnosis
