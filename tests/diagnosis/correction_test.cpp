#include "diagnosis/inference/correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.h"
#include "with_priors.h"

namespace pendular::diagnosis {
namespace {

TEST(Correction, UnknownIsLetInByItsOwnGate) {
  Correction correction;
  correction.level = 0.5, correction.gate = 0.3;
  const auto said = [](double unknown) {
    std::vector<Hypothesis> all = {{"a", 0.0, 0.9 * (1.0 - unknown), {}, 0.0},
                                   {"b", 0.0, 0.1 * (1.0 - unknown), {}, 0.0}};
    all.insert(unknown > 0.5 ? all.begin() : all.end(), {"unknown", 0.0, unknown, {}, 0.0});
    return all;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said(0.2), correction).ids, (Ids{"a"}));
  EXPECT_EQ(set_of(said(0.4), correction).ids, (Ids{"a", "unknown"}));
  EXPECT_EQ(set_of(said(0.7), correction).ids, (Ids{"unknown", "a"}));
  EXPECT_EQ(set_of(said(0.99), correction).ids, (Ids{"unknown"}));
}

TEST(Correction, APairStandsBesideItsEffectsUnlessItIsNotToldFromThem) {
  Correction correction;
  correction.level = 0.95;
  const std::vector<Hypothesis> said = {
      {"a", 0.0, 0.6, {}, 0.0}, {"a+b", 0.0, 0.36, {}, 0.0}, {"c", 0.0, 0.04, {}, 0.0}};
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said, correction).ids, (Ids{"a", "a+b"}));
  correction.untold_pairs = {"a+b"};
  const AmbiguitySet set = set_of(said, correction);
  EXPECT_EQ(set.ids, (Ids{"a"}));
  EXPECT_NEAR(set.probability, 0.96, 1e-12);
  // A pair that is more probable than both of its effects stands by itself.
  EXPECT_EQ(set_of({{"a+b", 0.0, 0.6, {}, 0.0}, {"a", 0.0, 0.4, {}, 0.0}}, correction).ids,
            (Ids{"a+b", "a"}));
}

TEST(Correction, NoneStandsForAnEffectTooSmallToBeToldWhereItIsTenTimesAsProbable) {
  Correction correction;
  correction.level = 0.99;
  correction.told_from["a"] = {INFINITY, 2.0};
  const auto said = [](double of_a, double theta) {
    return std::vector<Hypothesis>{{"none", 0.0, 0.9 - of_a, {}, 0.0},
                                   {"b", 0.0, 0.1, {{1.0, {0.0, 9.0}}}, 0.0},
                                   {"a", 0.0, of_a, {{theta, {0.0, 9.0}}}, 0.0}};
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said(0.08, 1.9), correction).ids, (Ids{"none", "b"}));
  EXPECT_NEAR(set_of(said(0.08, 1.9), correction).probability, 1.0, 1e-12);  // with what none stands for
  EXPECT_EQ(set_of(said(0.08, 2.0), correction).ids, (Ids{"none", "b", "a"}));
  EXPECT_EQ(set_of(said(0.08, -8.0), correction).ids, (Ids{"none", "b"}));
  EXPECT_EQ(set_of(said(0.083, 1.9), correction).ids, (Ids{"none", "b", "a"}));
}

TEST(Correction, AnEffectStandsForAPairWhoseOtherEffectIsTooSmallToBeTold) {
  Correction correction;
  correction.level = 0.99;
  correction.told_from["a"] = correction.told_from["b"] = {INFINITY, 2.0};
  const auto said = [](double of_a, double of_b) {
    const Magnitude a{of_a, {0.0, 9.0}}, b{of_b, {0.0, 9.0}};
    return std::vector<Hypothesis>{{"none", 0.0, 0.4, {}, 0.0},
                                   {"a", 0.0, 0.3, {a}, 0.0},
                                   {"a+b", 0.0, 0.2, {a, b}, 0.0},
                                   {"b", 0.0, 0.1, {b}, 0.0}};
  };
  using Ids = std::vector<std::string>;
  const AmbiguitySet set = set_of(said(3.0, 1.9), correction);
  EXPECT_EQ(set.ids, (Ids{"none", "a", "b"}));
  const auto all = said(3.0, 1.9);
  EXPECT_EQ(stands_for(all[2], set, all, correction), &all[1]);
  EXPECT_EQ(stands_for(all[1], set, all, correction), nullptr);  // is in it
  EXPECT_EQ(stands_for(all[2], {{"none"}, 0.4}, all, correction), nullptr);
  EXPECT_EQ(set_of(said(3.0, 2.0), correction).ids, (Ids{"none", "a", "a+b", "b"}));
  // What is left, b, is less probable than the pair: the pair stands by itself.
  EXPECT_EQ(set_of(said(1.9, 3.0), correction).ids, (Ids{"none", "a", "a+b", "b"}));
  EXPECT_EQ(stand_in(said(1.9, 1.9)[2], said(1.9, 1.9), correction)->id, "none");
  EXPECT_NEAR(set_of(said(3.0, 1.9), correction).probability, 1.0, 1e-12);
  // Evidence ten times as large lets the pair in.
  auto strong = said(3.0, 1.9);
  strong[2].log_evidence = correction.temperature * std::log(11.0);
  EXPECT_EQ(set_of(strong, correction).ids, (Ids{"none", "a", "a+b", "b"}));
}

TEST(Correction, WhatHasLessThanAHundredthIsNotBesideALeadingUnknown) {
  Correction correction;
  correction.level = 0.95;
  const auto said = [](double of_a) {
    return std::vector<Hypothesis>{{"unknown", 0.0, 1.0 - of_a, {}, 0.0}, {"a", 0.0, of_a, {}, 0.0}};
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said(0.011), correction).ids, (Ids{"unknown", "a"}));
  EXPECT_EQ(set_of(said(0.009), correction).ids, (Ids{"unknown"}));
}

TEST(Correction, StrongEvidenceLetsAPairStandBesideItsEffect) {
  Correction correction;
  correction.level = 0.95, correction.temperature = 2.0, correction.untold_pairs = {"a+b"};
  const auto said = [](double ratio) {
    return std::vector<Hypothesis>{{"a", 0.0, 0.8, {}, 0.0}, {"a+b", 2.0 * std::log(ratio), 0.2, {}, 0.0}};
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said(9.0), correction).ids, (Ids{"a"}));
  EXPECT_EQ(set_of(said(11.0), correction).ids, (Ids{"a", "a+b"}));
}

/// Two pairs that were run, two that were not, none, an effect and unknown.
std::vector<Hypothesis> with_pairs() {
  std::vector<Hypothesis> all = {{"none", 0.0, 0.3, {}, 0.0},    {"a", 1.0, 0.2, {}, 0.0},
                                 {"a+b", 3.0, 0.2, {}, 5.0},     {"a+c", 2.0, 0.1, {}, 6.0},
                                 {"b+c", 2.5, 0.08, {}, 7.0},    {"b+d", 1.5, 0.07, {}, 8.0},
                                 {"unknown", 0.5, 0.05, {}, 9.0}};
  all[4].run = all[5].run = false;
  return with_priors(all);
}

double of(const std::vector<Hypothesis>& said, const std::string& id) {
  for (const auto& h : said)
    if (h.id == id) return h.probability;
  return 0.0;
}

TEST(Correction, PairsThatWereNotRunAreOneExplanation) {
  // As probable as they are together, whatever the temperature.
  for (const double temperature : {1.0, 2.0, 4.0}) {
    Correction correction;
    correction.temperature = temperature;
    auto each = with_pairs();
    for (auto& h : each) h.run = true;
    const auto apart = corrected(each, correction), as_one = corrected(with_pairs(), correction);
    EXPECT_NEAR(of(as_one, kOtherPairs), of(apart, "b+c") + of(apart, "b+d"), 1e-12);
    EXPECT_NEAR(of(as_one, "a+c"), of(apart, "a+c"), 1e-12);
    EXPECT_EQ(of(as_one, "b+c"), 0.0);
  }
}

TEST(Correction, WhatIsUnknownIsJudgedByWhatReplayedRunsLeave) {
  Correction correction;
  correction.temperature = 1.0, correction.misfit = {0.1, 1.5, 0.5};
  for (int k = 1; k < 100; ++k) correction.misfits.push_back(k);
  const auto odds = [&](double of_a, double of_b) {
    const auto said = corrected(
        with_priors({{"a", 0.0, 0.6, {}, of_a}, {"b", 0.0, 0.3, {}, of_b}, {"unknown", 9.0, 0.1, {}, 0.0}}),
        correction);
    const double unknown = of(said, "unknown");
    EXPECT_NEAR(of(said, "a") / of(said, "b"), 2.0, 1e-12);
    EXPECT_NEAR(of(said, "a") + of(said, "b") + unknown, 1.0, 1e-12);
    return unknown / (1.0 - unknown);
  };
  const double of_one_in_twenty = 0.1 * std::pow(0.05, -1.5);
  EXPECT_NEAR(odds(0.5, 0.5), 0.1, 1e-12);  // all runs leave more
  EXPECT_NEAR(odds(95.5, 95.5), of_one_in_twenty, 1e-9);
  EXPECT_NEAR(odds(95.5, 0.5), (2.0 * of_one_in_twenty + 0.1) / 3.0, 1e-9);
  EXPECT_NEAR(odds(1e9, 1e9), 0.1 * std::pow(0.01, -1.5), 1e-9);
}

// Strong gaps leave evidences that no floating-point probability has room for.
TEST(Correction, WhatIsOutOfTheQuestionIsSoAtAnyTemperature) {
  for (const double temperature : {1.0, 1.5, 5.0}) {
    Correction correction;
    correction.temperature = correction.temperature_of_pairs = temperature;
    const auto said = corrected({{"a", -190.0, 1.0, {}, 0.0},
                                 {"b", -3000.0, 0.0, {}, 0.0},
                                 {"none", -15000.0, 0.0, {}, 0.0},
                                 {"b+c", -20000.0, 0.0, {}, 0.0}},
                                correction);
    EXPECT_EQ(said.front().id, "a");
    EXPECT_DOUBLE_EQ(said.front().probability, 1.0);
    EXPECT_EQ(of(said, "none") + of(said, "b+c"), 0.0);
  }
}

TEST(Correction, APairHasWhatItsEffectsHaveAndItsOwnAtItsOwnTemperature) {
  Correction correction;
  correction.temperature = 2.0, correction.temperature_of_pairs = 5.0;
  const auto said = corrected({{"none", 0.0, 0.25, {}, 0.0},
                               {"a", 4.0, 0.25 * std::exp(4.0), {}, 0.0},
                               {"b", 3.0, 0.25 * std::exp(3.0), {}, 0.0},
                               {"a+b", 14.0, 0.25 * std::exp(14.0), {}, 0.0}},
                              correction);
  EXPECT_NEAR(of(said, "a") / of(said, "none"), std::exp(4.0 / 2.0), 1e-9);
  EXPECT_NEAR(of(said, "a+b") / of(said, "a"), std::exp(10.0 / 5.0), 1e-9);
}

TEST(Correction, WhatIsNotProbableIsInNoSetAtAnyLevel) {
  Correction correction;
  correction.level = 1.0;
  const std::vector<Hypothesis> said = {{"a", 0.0, 0.9, {}, 0.0},
                                        {"b", 0.0, 0.08, {}, 0.0},
                                        {"none", 0.0, 0.02, {}, 0.0},
                                        {"c", 0.0, 0.001, {}, 0.0}};
  EXPECT_EQ(set_of(said, correction).ids, (std::vector<std::string>{"a", "b", "none"}));
  EXPECT_EQ(set_of({{"a", 0.0, 0.005, {}, 0.0}}, correction).ids, (std::vector<std::string>{"a"}));
}

TEST(Correction, PairsThatWereNotRunAreInNoSetButFirst) {
  Correction correction;
  correction.level = 0.6, correction.gate = 0.3;
  const auto said = [](double others, double unknown) {
    const double left = 1.0 - others - unknown;
    std::vector<Hypothesis> all = {{"a", 0.0, 0.7 * left, {}, 0.0},
                                   {"b", 0.0, 0.3 * left, {}, 0.0},
                                   {kOtherPairs, 0.0, others, {}, 0.0},
                                   {"unknown", 0.0, unknown, {}, 0.0}};
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& x, const auto& y) { return x.probability > y.probability; });
    return all;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set_of(said(0.1, 0.25), correction).ids, (Ids{"a"}));
  EXPECT_EQ(set_of(said(0.1, 0.31), correction).ids, (Ids{"a", "unknown"}));
  EXPECT_EQ(set_of(said(0.6, 0.1), correction).ids, (Ids{kOtherPairs, "a"}));
}

}  // namespace
}  // namespace pendular::diagnosis
