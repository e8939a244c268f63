#include "diagnosis/inference/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "diagnosis/thresholds.h"
#include "with_priors.h"

namespace pendular::diagnosis {
namespace {

constexpr int kMembers = 10, kOfMember = 60;
const std::vector<std::string> kIds = {"none", "a", "b", "c", "unknown"};

/// Runs of known truth whose evidence is that of a single normal reading per explanation, told `sharper`
/// times as sharply as is right: at 1 the probabilities are those of Bayes' rule.
std::vector<Replayed> runs(double sharper, double theta_error, std::uint64_t seed) {
  std::vector<Replayed> all;
  for (int k = 0; k < kMembers * kOfMember; ++k) {
    const auto n = static_cast<std::uint64_t>(k);
    const std::size_t truth = n % 4;
    Replayed one{1 + k % kMembers, {}, {}};
    if (truth > 0) one.truth[kIds[truth]] = 1.0;
    double total = 0.0;
    for (std::size_t h = 0; h < kIds.size(); ++h) {
      const double seen = random_normal(seed + h, n) + (h == truth ? 2.0 : 0.0);
      // Of a reading that is 2 under its own explanation and 0 under the others.
      Hypothesis said{kIds[h], sharper * (2.0 * seen - 2.0), 0.0, {}, 0.0};
      if (kIds[h] == "unknown") said.log_evidence = sharper * -6.0;
      said.probability = std::exp(said.log_evidence);
      total += said.probability;
      if (h > 0 && h < 4) {
        const double mean = 1.0 + theta_error * random_normal(seed + 100 + h, n);
        said.magnitudes = {{mean, {mean - 1.645, mean + 1.645}}};
      }
      one.said.push_back(said);
    }
    for (auto& h : one.said) h.probability /= total;
    std::stable_sort(one.said.begin(), one.said.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
    all.push_back(std::move(one));
  }
  return all;
}

TEST(Calibration, LeavesRightProbabilitiesAlone) {
  const Promise promise = promise_of(runs(1.0, 1.0, 1), 0.95);
  EXPECT_EQ(promise.cases, static_cast<std::size_t>(kMembers * kOfMember));
  EXPECT_LE(promise.correction.temperature, 1.25);
  for (const auto& bin : promise.reliability) {
    if (bin.cases < 50) continue;
    EXPECT_NEAR(bin.said * (1.0 + Misfit{}.odds), bin.came_true, 0.08);  // none of them is unknown
  }
  EXPECT_NEAR(promise.theta_held, 0.9, 0.04);
  EXPECT_LT(promise.correction.widening.others, 1.15);
  EXPECT_GE(promise.limits_held, 0.95);  // of either sign: wider than one-sided
}

TEST(Calibration, MendsProbabilitiesAndIntervalsThatAreTooSharp) {
  const auto sharp = runs(3.0, 2.0, 2);
  const Promise promise = promise_of(sharp, 0.95);
  EXPECT_NEAR(promise.correction.temperature, 3.0, 1.01);
  EXPECT_NEAR(promise.correction.widening.others, 2.0, 0.3);  // errors are twice as large as stated
  EXPECT_NEAR(promise.theta_held, 0.9, 0.04);
  for (const auto& bin : promise.reliability) {
    if (bin.cases < 50) continue;
    EXPECT_NEAR(bin.said, bin.came_true, 0.08);
  }
}

TEST(Calibration, SetsHoldTheTruthAsOftenAsAsked) {
  for (const double confidence : {0.8, 0.95}) {
    const auto learnt = runs(2.0, 1.0, 3), fresh = runs(2.0, 1.0, 4);
    const Promise promise = promise_of(learnt, confidence);
    const double of_replayed = 1.0 - kThresholds.missed_by_replay * (1.0 - confidence);
    EXPECT_EQ(promise.confidence, confidence);
    EXPECT_NEAR(promise.in_set, of_replayed, 0.03);
    double held = 0.0;  // by runs that nothing was learnt from
    for (const auto& one : fresh) {
      const auto set = set_of(corrected(one.said, promise.correction), promise.correction);
      const std::string truth = one.truth.empty() ? "none" : one.truth.begin()->first;
      held += std::find(set.ids.begin(), set.ids.end(), truth) != set.ids.end();
    }
    EXPECT_NEAR(held / static_cast<double>(fresh.size()), of_replayed, 0.03);
  }
}

TEST(Calibration, TruthsThatAreOutOfTheQuestionAreNotHeld) {
  const auto temperature = [](double of_truths) {
    auto all = runs(1.0, 1.0, 12);
    for (std::size_t k = 0; k < all.size(); k += 10)
      for (auto& h : all[k].said)
        if (h.id == truth_of(all[k])) h.log_evidence += of_truths;
    return promise_of(all, 0.95).correction.temperature;
  };
  EXPECT_EQ(temperature(-9000.0), temperature(-20.0));
}

TEST(Calibration, PairsThatFitByChanceAreTempered) {
  // Beside each effect a pair that has more by an exponential law, which no run is made of.
  const auto with_chance = [](double mean) {
    auto all = runs(1.0, 1.0, 31);
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::vector<Hypothesis> pairs;
      for (const auto& h : all[k].said)
        if (h.id == "a" || h.id == "b" || h.id == "c") {
          const double beyond = -mean * std::log(random_uniform(77, 8 * k + pairs.size())) - 2.0;
          pairs.push_back({h.id + "+d", h.log_evidence + beyond, h.probability * std::exp(beyond), {}, 0.0});
        }
      for (auto& pair : pairs) all[k].said.push_back(std::move(pair));
    }
    return promise_of(all, 0.95).correction;
  };
  const Correction little = with_chance(0.2), much = with_chance(4.0);
  EXPECT_LE(much.temperature, 1.5);  // effects are weighed as they are without pairs
  EXPECT_GE(much.temperature_of_pairs, 2.5 * much.temperature);
  EXPECT_LE(little.temperature_of_pairs, much.temperature_of_pairs);
}

// Where runs were told as something else without doubt, no level short of one holds them.
TEST(Calibration, PairsThatWereRunAreInSetsAsOftenAsAsked) {
  // Runs of b and c together say so with the evidence that others have for what is true of them.
  auto all = runs(1.0, 1.0, 8);
  const auto rename = [](std::string& id) { id = id == "b" ? "b+c" : id; };
  for (auto& one : all) {
    if (one.truth.contains("b")) one.truth = {{"b", 1.0}, {"c", 1.0}};
    for (auto& h : one.said) rename(h.id);
  }
  EXPECT_EQ(truth_of(all[2]), "b+c");
  const Promise promise = promise_of(all, 0.9);
  EXPECT_EQ(promise.cases, all.size());
  const EffectReplay& pair = promise.effects.at("b+c");
  EXPECT_EQ(pair.cases, all.size() / 4);
  EXPECT_GT(static_cast<double>(pair.in_set), 0.82 * static_cast<double>(pair.cases));
}

TEST(Calibration, RunsWhoseEffectWasLeftOutAreCountedAndTeachNothing) {
  auto all = runs(1.0, 1.0, 11);
  const Promise known = promise_of(all, 0.95);
  // Ten that a leaves far off, and twenty that it does not.
  for (int k = 0; k < 30; ++k) {
    Replayed one{1 + k % kMembers, {{"d", 1.0}}, {}, "d"};
    one.said = {{"a", -0.1, 0.9, {{1.0, {0.0, 2.0}}}, k < 10 ? 1.0 : 0.0}, {"unknown", -2.3, 0.1, {}, 0.0}};
    EXPECT_EQ(truth_of(one), "unknown");
    all.push_back(std::move(one));
  }
  const Promise promise = promise_of(all, 0.95);
  EXPECT_EQ(promise.outside.cases, 30u);
  EXPECT_EQ(promise.outside.flagged, 10u);
  EXPECT_EQ(promise.outside.misnamed, 20u);
  EXPECT_EQ(promise.cases, known.cases);
  EXPECT_EQ(promise.correction.temperature, known.correction.temperature);
  EXPECT_EQ(promise.correction.misfits, known.correction.misfits);
  EXPECT_EQ(promise.in_set, known.in_set);
  EXPECT_EQ(promise.effects.count("d"), 0u);
  EXPECT_EQ(known.outside.cases, 0u);
}

TEST(Calibration, PairsThatWerePutTogetherAreCountedAndTeachNothing) {
  auto all = runs(1.0, 1.0, 11);
  const Promise known = promise_of(all, 0.95);
  // Ten of a pair that leads, ten of one that is not thought of, and one whose effects are told at no
  // magnitude.
  for (int k = 0; k < 20; ++k) {
    Replayed one{1 + k % kMembers, {{"a", 1.0}, {"b", 1.0}}, {}};
    one.put_together = true;
    one.said = {{k < 10 ? "b+a" : "c", -0.1, 0.9, {{1.0, {0.0, 2.0}}}, 1.0}, {"none", -2.3, 0.1, {}, 1.0}};
    if (k < 10) one.said.front().magnitudes.push_back({1.0, {0.0, 2.0}});
    all.push_back(std::move(one));
  }
  all.push_back(all.back());
  all.back().truth = {{"a", 1e-9}, {"b", 1.0}};
  const Promise promise = promise_of(all, 0.95);
  EXPECT_EQ(promise.pairs.cases, 20u);
  EXPECT_EQ(promise.pairs.in_set, 10u);
  EXPECT_EQ(promise.pairs.first, 10u);
  EXPECT_EQ(promise.cases, known.cases);
  EXPECT_EQ(promise.correction.temperature, known.correction.temperature);
  EXPECT_EQ(promise.in_set, known.in_set);
  EXPECT_EQ(promise.effects.count("a+b"), 0u);
  EXPECT_EQ(known.pairs.cases, 0u);
}

TEST(Calibration, EffectsOnTablesOfBeadsWidenNoOthers) {
  auto all = runs(1.0, 1.0, 1);
  for (auto& one : all) {
    if (one.truth.contains("c")) one.truth = {{"position_error", 1.0}};
    for (auto& h : one.said)
      if (h.id == "c") {
        h.id = "position_error";
        Magnitude& m = h.magnitudes.front();
        m.mean -= 5.0, m.interval_90.first -= 5.0, m.interval_90.second -= 5.0;
      }
  }
  const Promise promise = promise_of(all, 0.95);
  EXPECT_GT(promise.correction.widening.own.at("position_error"), 3.0);
  for (const char* id : {"a", "b"}) EXPECT_LT(promise.correction.widening.own.at(id), 1.3) << id;
  EXPECT_LT(promise.correction.widening.others, 1.2);
  EXPECT_NEAR(promise.theta_held, 0.9, 0.04);
}

/// Runs in which these members went to a magnitude that is found too small by far.
std::vector<Replayed> runs_that_go_far(int last_member) {
  auto all = runs(1.0, 1.0, 1);
  for (auto& one : all)
    if (one.member <= last_member)
      for (auto& [id, theta] : one.truth) theta = 5.0;
  return all;
}

// Of b one member alone went there: where it is left out the bank does not span it.
TEST(Calibration, IntervalsAreLearntFromRunsThatOthersSpan) {
  const Promise alone = promise_of(runs_that_go_far(1), 0.95);
  EXPECT_LT(alone.correction.widening.own.at("b"), 1.3);
  EXPECT_NEAR(alone.theta_held, 0.9, 0.04);
  const Promise spanned = promise_of(runs_that_go_far(3), 0.95);  // two members of b
  EXPECT_GT(spanned.correction.widening.own.at("b"), 2.0);
}

TEST(Calibration, TooFewRunsPromiseNothingAndWiden) {
  auto few = runs(1.0, 1.0, 5);
  few.resize(20);
  const Promise promise = promise_of(few, 0.95);
  EXPECT_EQ(promise.cases, 0u);
  EXPECT_GE(promise.correction.temperature, 2.0);
  EXPECT_GE(promise.correction.widening.others, 2.0);
}

TEST(Calibration, EffectsThatLookLikeNoneAreListed) {
  auto all = runs(1.0, 1.0, 6);
  for (auto& one : all)  // c is never told from none
    if (one.truth.contains("c"))
      for (auto& h : one.said) h.probability = h.id == "none" ? 0.97 : 0.01;
  for (auto& one : all) {
    one.said = with_priors(std::move(one.said));
    std::stable_sort(one.said.begin(), one.said.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
  }
  const Promise promise = promise_of(all, 0.8);
  for (const auto& [id, from] : promise.correction.told_from) EXPECT_EQ(from.tells(1.0), id != "c") << id;
  // None stands for it.
  EXPECT_EQ(promise.effects.at("c").in_set, promise.effects.at("c").cases);
  EXPECT_GE(promise.in_set, 0.78);
  const auto set = [&](std::initializer_list<std::pair<const char*, double>> said) {
    std::vector<Hypothesis> hypotheses;
    for (const auto& [id, probability] : said) {
      hypotheses.push_back({id, 0.0, probability, {}, 0.0});
      if (!effects_in(id).empty()) hypotheses.back().magnitudes = {{1.0, {0.0, 2.0}}};
    }
    Correction correction = promise.correction;
    correction.level = 0.9, correction.levels.clear(), correction.gate = 1.0;
    return set_of(hypotheses, correction).ids;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(set({{"none", 0.85}, {"a", 0.1}, {"c", 0.05}}), (Ids{"none", "a"}));
  EXPECT_EQ(set({{"c", 0.5}, {"a", 0.45}, {"none", 0.05}}), (Ids{"c", "a"}));  // it shows for once
}

TEST(Calibration, NoneIsRightForAnEffectBelowWhatHalfOfItsRunsAreToldAt) {
  auto all = runs(1.0, 0.05, 9);
  for (std::size_t k = 0; k < all.size(); ++k) {
    Replayed& one = all[k];
    if (!one.truth.contains("c")) continue;
    const double theta = (k / 4) % 3 == 0 ? 2.0 : 1.0;  // the larger one is told from none
    one.truth["c"] = theta;
    for (auto& h : one.said) {
      h.probability = h.id == (theta < 2.0 ? "none" : "c") ? 0.97 : 0.01;
      h.log_evidence = std::log(h.probability);
      if (h.id == "c") h.magnitudes = {{theta, {theta - 0.1, theta + 0.1}}};
    }
    std::stable_sort(one.said.begin(), one.said.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
  }
  const Promise promise = promise_of(all, 0.8);
  const ToldFrom& from = promise.correction.told_from.at("c");
  EXPECT_DOUBLE_EQ(from.positive, 2.0);
  EXPECT_DOUBLE_EQ(from.negative, 0.0);  // nothing was run there: nothing is known
  EXPECT_EQ(promise.effects.at("c").in_set, promise.effects.at("c").cases);
  std::size_t held = 0;
  for (const auto& run : promise.effects.at("c").runs) {
    EXPECT_EQ(run.in_set, run.theta >= 2.0);
    held += run.in_set;
  }
  EXPECT_GT(held, 0u);
}

TEST(Calibration, AnEffectIsSeenFromWhereItsRunsAreToldFromNone) {
  EffectReplay effect;
  EXPECT_EQ(effect.seen_from(), INFINITY);
  effect.runs = {{0.1, false, true}, {-0.2, true, true}, {0.2, false, false}, {0.3, true, true}};
  EXPECT_DOUBLE_EQ(effect.seen_from(), 0.3);  // at 0.2 one of two is told, of three from there two
  effect.runs[2].told_from_none = true;
  EXPECT_DOUBLE_EQ(effect.seen_from(), 0.2);
  effect.runs.push_back({0.4, false, true});
  EXPECT_EQ(effect.seen_from(), INFINITY);
}

TEST(Calibration, KeepsTheMagnitudesOfReplayedRuns) {
  auto all = runs(1.0, 1.0, 8);
  const Promise promise = promise_of(all, 0.9);
  std::size_t cases = promise.none.cases;
  for (const auto& [id, effect] : promise.effects) {
    cases += effect.cases;
    ASSERT_EQ(effect.runs.size(), effect.cases);
    std::size_t told = 0;
    for (const auto& run : effect.runs) told += run.told_from_none;
    EXPECT_EQ(told, effect.told_from_none) << id;
  }
  EXPECT_EQ(cases, promise.cases);
  EXPECT_GT(static_cast<double>(promise.none.in_set), 0.8 * static_cast<double>(promise.none.cases));
}

TEST(Calibration, UpperLimitsHoldAsOftenAsTheySay) {
  for (const double error : {1.0, 2.5}) {
    const Promise promise = promise_of(runs(1.0, error, 7), 0.95);
    EXPECT_GE(promise.limits_held, 0.93) << error;
  }
}

}  // namespace
}  // namespace pendular::diagnosis
