#include "diagnosis_report/json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

#include "planted_diagnosis.h"

namespace pendular {
namespace {

using diagnosis_report::to_json;
using nlohmann::json;

/// As a script would read it.
json read_back(const diagnosis::Diagnosis& diagnosis) {
  return json::parse(to_json(diagnosis).dump());
}

void expect_keys(const json& object, const std::vector<std::string>& keys) {
  for (const auto& key : keys)
    EXPECT_TRUE(object.contains(key)) << key << " in " << object.dump().substr(0, 80);
}

double sum_of_probabilities(const json& report) {
  double sum = 0.0;
  for (const auto& h : report["hypotheses"]) sum += h["probability"].get<double>();
  return sum;
}

const json& hypothesis(const json& report, const std::string& id) {
  for (const auto& h : report["hypotheses"])
    if (h["id"] == id) return h;
  throw std::out_of_range(id);
}

TEST(DiagnosisJson, HasEveryKeyThatScriptsRelyOn) {
  const auto diagnosis = test::planted_diagnosis();
  const json report = read_back(diagnosis);
  expect_keys(report, {"verdict", "gap", "hypotheses", "ambiguity_set", "shrinkage", "next_experiments",
                       "noise_floor", "runs", "provenance"});
  ASSERT_EQ(report["gap"].size(), diagnosis.gap.rows.size());
  for (const auto& row : report["gap"])
    expect_keys(row, {"observation", "feature", "strain_range", "observed", "simulated", "log_ratio", "sigma",
                      "z", "significant", "share"});
  ASSERT_EQ(report["hypotheses"].size(), diagnosis.explanations.size());
  for (const auto& row : report["hypotheses"]) {
    expect_keys(row, {"id", "probability", "magnitude", "interval_90", "unit", "excluded", "reason"});
    EXPECT_EQ(row["interval_90"].size(), 2u);
  }
  for (const char* data : {"fitted", "withheld"})
    expect_keys(report["shrinkage"][data], {"before", "after", "fraction", "interval_90"});
  expect_keys(report["shrinkage"]["withheld"], {"observations"});
  expect_keys(report["shrinkage"]["controls"], {"modulus_retuned", "wrong_effect"});
  ASSERT_EQ(report["next_experiments"].size(), 3u);
  expect_keys(report["next_experiments"][0], {"observation", "expected_probability_resolved", "why", "cost",
                                              "gain_bits", "outlook", "runs_missing"});
  EXPECT_TRUE(report["next_experiments"][2]["expected_probability_resolved"].is_null());
  EXPECT_EQ(report["provenance"]["command"], "pendular diagnose experiment.toml");
}

TEST(DiagnosisJson, ListsEveryEffectAndSumsToOne) {
  const auto diagnosis = test::planted_diagnosis();
  const json report = read_back(diagnosis);
  EXPECT_NEAR(sum_of_probabilities(report), 1.0, 1e-12);
  EXPECT_NEAR(sum_of_probabilities(read_back(test::quiet_diagnosis())), 1.0, 1e-12);
  for (const auto& effect : diagnosis.effects) EXPECT_EQ(hypothesis(report, effect)["unit"], "fraction");
  EXPECT_TRUE(hypothesis(report, "none")["magnitude"].is_null());
  EXPECT_TRUE(hypothesis(report, "unknown")["interval_90"][0].is_null());
}

TEST(DiagnosisJson, APairHasTheMagnitudesOfBothAndTheFirstOnesByItself) {
  const json report = read_back(test::planted_diagnosis());
  const json& pair = hypothesis(report, "missing_bridges+platen_tilt");
  EXPECT_EQ(pair["magnitude"], pair["magnitudes"][0]);
  EXPECT_EQ(pair["interval_90"], pair["intervals_90"][0]);
  EXPECT_EQ(pair["magnitudes"].size(), 2u);
  EXPECT_EQ(pair["units"], json({"fraction", "degrees"}));
}

TEST(DiagnosisJson, ExplanationsHavePlainNames) {
  const json report = read_back(test::planted_diagnosis());
  EXPECT_EQ(hypothesis(report, "missing_bridges")["name"], "bridges missing between near beads");
  EXPECT_EQ(hypothesis(report, "missing_bridges")["in_words"],
            "bridges missing between near beads (missing_bridges), 12 % (8 to 16 %)");
  for (const auto& h : report["hypotheses"])
    EXPECT_FALSE(h["sentence"].get<std::string>().empty()) << h["id"];
}

TEST(DiagnosisJson, OfAGapWithinTheNoiseNoShareIsClosed) {
  auto diagnosis = test::planted_diagnosis();
  diagnosis.fitted.nothing_to_close = diagnosis.withheld.nothing_to_close = true;
  const json shrinkage = read_back(diagnosis)["shrinkage"];
  EXPECT_TRUE(shrinkage["withheld"]["fraction"].is_null());
  EXPECT_TRUE(shrinkage["withheld"]["nothing_to_close"]);
  EXPECT_TRUE(shrinkage["controls"]["modulus_retuned"].is_null());
  EXPECT_FALSE(shrinkage["withheld"]["before"].is_null());
}

TEST(DiagnosisJson, LogarithmOfTheRatioWhereverThereIsOne) {
  auto diagnosis = test::planted_diagnosis();
  auto& by_difference = diagnosis.gap.rows[0];
  ASSERT_FALSE(by_difference.observed.logarithm);
  by_difference.observed.value = 0.01, by_difference.simulated = 0.02;
  const json row = read_back(diagnosis)["gap"][0];
  EXPECT_NEAR(row["log_ratio"].get<double>(), std::log(2.0), 1e-12);
  EXPECT_EQ(row["compared_by"], "difference");
  diagnosis.gap.rows[0].simulated = -0.02;
  EXPECT_TRUE(read_back(diagnosis)["gap"][0]["log_ratio"].is_null());
  EXPECT_DOUBLE_EQ(read_back(diagnosis)["gap"][1]["log_ratio"], diagnosis.gap.rows[1].difference);
}

TEST(DiagnosisJson, WhatIsNotFiniteOrNotMadeIsNull) {
  auto diagnosis = test::planted_diagnosis();
  diagnosis.gap.rows[0].z = std::numeric_limits<double>::quiet_NaN();
  diagnosis.withheld.interval_90.second = std::numeric_limits<double>::infinity();
  const json report = read_back(diagnosis);
  EXPECT_TRUE(report["gap"][0]["z"].is_null());
  EXPECT_TRUE(report["shrinkage"]["withheld"]["interval_90"][1].is_null());
  const json quiet = read_back(test::quiet_diagnosis());
  EXPECT_TRUE(quiet["shrinkage"]["fitted"]["fraction"].is_null());
  EXPECT_TRUE(quiet["shrinkage"]["controls"]["modulus_retuned"].is_null());
}

TEST(DiagnosisJson, TellsFromWhichMagnitudeOnEachEffectIsTold) {
  auto diagnosis = test::planted_diagnosis();
  for (const char* id : {"bead_friction", "platen_tilt"}) diagnosis.promise.effects[id].cases = 1;
  diagnosis.promise.correction.told_from = {{"bead_friction", {0.2, INFINITY}}, {"platen_tilt", {0.0, 0.3}}};
  const json effects = read_back(diagnosis)["promise"]["effects"];
  EXPECT_EQ(effects["bead_friction"]["told_from"]["negative"], 0.2);
  EXPECT_TRUE(effects["bead_friction"]["told_from"]["positive"].is_null());  // told at no magnitude
  EXPECT_FALSE(effects["platen_tilt"]["told_from"].contains("negative"));    // nothing was run there
  EXPECT_EQ(effects["platen_tilt"]["told_from"]["positive"], 0.3);
}

TEST(DiagnosisJson, NamesTheBeadsOfAPlace) {
  auto diagnosis = test::planted_diagnosis();
  diagnosis::Place place;
  place.observation = "scan", place.strain = 0.015, place.cut = 2.0;
  place.ids = {11, 12, 13};
  place.misfit.value = {1.0, 5.0, 2.5};
  diagnosis.places = {place};
  const json report = read_back(diagnosis);
  ASSERT_EQ(report["places"].size(), 1u);
  EXPECT_EQ(report["places"][0]["observation"], "scan");
  EXPECT_EQ(report["places"][0]["beads"], 3);
  EXPECT_EQ(report["places"][0]["bead_ids"], (std::vector<int>{12, 13}));
}

TEST(DiagnosisJson, CountsFailedRuns) {
  const json report = read_back(test::planted_diagnosis());
  EXPECT_EQ(report["runs"], 30);
  EXPECT_EQ(report["failed_runs"], 1);
  EXPECT_EQ(report["runs_by_status"]["failed"], 1);
}

}  // namespace
}  // namespace pendular
