#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "seven_cases.h"

namespace pendular::blind {

using nlohmann::json;
using namespace seven_cases;

TEST_F(Score, CountsNames) {
  const Scores s = scores();
  EXPECT_EQ(s.cases, 7u);
  EXPECT_EQ(s.failed, 1u);
  EXPECT_EQ(s.all.in_set.hits, 4u);
  EXPECT_EQ(s.all.in_set.of, 7u);  // the missing report counts
  EXPECT_EQ(s.all.exact.hits, 3u);
  EXPECT_EQ(s.all.exact_separable.hits, 2u);  // c1 and c3 of c1, c3, c4, c6
  EXPECT_EQ(s.all.exact_separable.of, 4u);
  EXPECT_EQ(s.all.confidently_wrong.hits, 2u);
  EXPECT_DOUBLE_EQ(s.all.set_size, 8.0 / 6.0);
  EXPECT_EQ(s.by_stratum.at(Stratum::library).exact.hits, 1u);
  EXPECT_EQ(s.by_answer.at("unknown").in_set.hits, 1u);
}

TEST_F(Score, ATruthThatDoesNotSayWhatWasObservedIsRefused) {
  const fs::path sealed = folder / "split/sealed/c1.json";
  json truth = json::parse(read_text(sealed));
  const auto refused = [&](const std::string& says) {
    write_text(sealed, truth.dump());
    try {
      read_truth(sealed);
      ADD_FAILURE() << says;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  };
  truth["observed"] = "scans";
  refused("the nearest known one is \"scan\"");
  truth.erase("observed");
  refused("have to be made anew");
}

TEST_F(Score, HiddenEffectsCountByThemselves) {
  const fs::path root = folder / "hidden";
  const json tilt = {{{"id", "platen_tilt"}, {"theta", 0.01}}};
  std::string seals = "case,sha256\n";
  for (const char* name : {"h1", "h2", "h3"})
    seals += seal(root, name, "library", "platen_tilt", tilt, "", {{"hidden", true}, {"observed", "scan"}});
  seals += seal(root, "s1", "library", "platen_tilt", tilt, "", {{"hidden", false}, {"observed", "scan"}});
  write_text(root / "seals.csv", seals);
  report(reports / "h1", {claim("none", 0.9), claim("unknown", 0.1)}, {"none"});
  json unseen = {{"unseen", {{{"effect", "platen_tilt"}, {"limit_95", 0.1}}}}};
  add_to_report(reports / "h1", unseen);
  report(reports / "h2", {claim("platen_tilt", 0.95), claim("none", 0.05)}, {"platen_tilt"});
  report(reports / "h3", {claim("grit", 0.95), claim("none", 0.05)}, {"grit"});
  report(reports / "s1", {claim("platen_tilt", 0.95, 0.011, 0.009, 0.012), claim("none", 0.05)},
         {"platen_tilt"});
  const Scores s = score(verdicts(open_seals(root), reports), false);
  EXPECT_EQ(s.hidden.allowed.of, 3u);
  EXPECT_EQ(s.hidden.allowed.hits, 2u);
  EXPECT_EQ(s.hidden.misnamed.hits, 1u);
  EXPECT_EQ(s.kept.limits.of, 1u);
  EXPECT_EQ(s.kept.limits.hits, 1u);
  EXPECT_EQ(s.all.in_set.of, 1u);
  const Bars& with_scan = s.by_observed[static_cast<std::size_t>(Observed::scan)];
  EXPECT_EQ(with_scan.single_first.hits, 1u);
  EXPECT_EQ(with_scan.magnitude.covered.hits, 1u);
  EXPECT_EQ(s.by_observed[static_cast<std::size_t>(Observed::second_specimen)].naming.in_set.of, 0u);
}

/// Squared distances at usual magnitudes: friction is 2 from none and 4 from missing bridges, and so on.
json separation() {
  return {{"separation",
           {{"effects", {"bead_friction", "missing_bridges"}},
            {"squared_distance", {{0.0, 16.0, 4.0}, {16.0, 0.0, 100.0}}}}}};
}

TEST_F(Score, CountsWhatAnIdealObserverCannotTellApartAsOne) {
  for (const char* name : {"c1", "c2", "c3", "c4"}) add_to_report(reports / name, separation());
  const auto all = verdicts(open_seals(folder / "split"), reports);
  // θ of c1 is two thirds of the usual 0.15: missing bridges are 16^½ ⅔ = 2.7 from friction, and 6.7 from
  // none.
  EXPECT_NEAR(distance_from_truth(all[0], "bead_friction"), 8.0 / 3.0, 1e-12);
  EXPECT_FALSE(is_right(all[0], "none", Counting::by_class));
  // θ of c2 is the usual one: `none`, which the report has first, is not told from the truth.
  EXPECT_EQ(class_of(all[1]), std::vector<std::string>{"none"});
  EXPECT_FALSE(is_right(all[1], "unknown", Counting::by_class));
  EXPECT_TRUE(class_of(all[4]).empty());  // an outside mechanism
  const Scores s = score(all, false);
  EXPECT_EQ(s.with_distances, 4u);
  EXPECT_EQ(s.all.exact.hits, 3u);
  EXPECT_EQ(s.all_by_class.exact.hits, 4u);
  EXPECT_EQ(s.all_by_class.in_set.hits, s.all.in_set.hits);
  EXPECT_DOUBLE_EQ(s.all_by_class.set_size, 7.0 / 6.0);  // c2's two members are one answer
  EXPECT_LT(s.all_by_class.log_score, s.all.log_score);
  std::size_t by_name = 0, by_class = 0;  // c2's is one more
  for (const auto& bin : s.kept.reliability) by_name += bin.right.hits, by_class += bin.right_by_class.hits;
  EXPECT_EQ(by_name, 3u);
  EXPECT_EQ(by_class, 4u);
}

json told_from(const char* effect, const json& positive) {
  return {{"promise", {{"effects", {{effect, {{"told_from", {{"positive", positive}}}}}}}}}};
}

TEST_F(Score, WhatAReportDoesNotTellFromNoneIsOneWithIt) {
  const auto of = [&](const char* name, std::size_t at, const json& positive) {
    add_to_report(reports / name, told_from("missing_bridges", positive));
    return verdicts(open_seals(folder / "split"), reports)[at];
  };
  const auto there = [&](const json& positive) { return of("c1", 0, positive); };  // 0.1 of it
  EXPECT_TRUE(is_right(there(0.11), "none", Counting::by_class));
  EXPECT_TRUE(is_right(there(nullptr), "none", Counting::by_class));  // told at no magnitude
  EXPECT_FALSE(is_right(there(0.1), "none", Counting::by_class));
  EXPECT_FALSE(is_right(there(0.11), "none", Counting::by_name));
  EXPECT_FALSE(is_right(there(0.11), "platen_tilt", Counting::by_class));
  // Nothing was withheld, and what is said is less than what is told.
  report(reports / "c4", {claim("missing_bridges", 0.6, 0.05), claim("none", 0.4)}, {"missing_bridges"});
  EXPECT_TRUE(is_right(of("c4", 3, 0.06), "missing_bridges", Counting::by_class));
  EXPECT_FALSE(is_right(of("c4", 3, 0.04), "missing_bridges", Counting::by_class));
}

TEST_F(Score, ASetWithNoneIsRightForWhatTheReportDoesNotTell) {
  report(reports / "c1", {claim("none", 0.9), claim("missing_bridges", 0.1)}, {"none"});
  const auto verdict = [&](const json& positive) {
    add_to_report(reports / "c1", told_from("missing_bridges", positive));
    return verdicts(open_seals(folder / "split"), reports)[0];
  };
  EXPECT_TRUE(verdict(0.11).set_is_right());
  EXPECT_FALSE(verdict(0.11).in_set("missing_bridges"));
  EXPECT_FALSE(verdict(0.1).set_is_right());
  report(reports / "c1", {claim("platen_tilt", 0.9), claim("none", 0.1)}, {"platen_tilt"});
  EXPECT_FALSE(verdict(0.11).set_is_right());
}

TEST_F(Score, PairsAreAlikeWhereWhatStandsForWhatIsNear) {
  report(reports / "c7", {claim("missing_bridges", 0.9), claim("none", 0.1)}, {"missing_bridges"});
  add_to_report(reports / "c7", separation());
  const auto pair = verdicts(open_seals(folder / "split"), reports)[6];
  EXPECT_DOUBLE_EQ(distance_from_truth(pair, "missing_bridges"), 4.0);  // friction by missing bridges
  EXPECT_NEAR(distance_from_truth(pair, "bead_friction"), 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(distance_from_truth(pair, "none"), 2.0 + 20.0 / 3.0, 1e-12);
  EXPECT_EQ(distance_from_truth(pair, pair.answer), 0.0);
}

TEST_F(Score, PromisesAtAMagnitudeAreOfReplayedRunsNearIt) {
  // A run at such a magnitude counts half as much as one at θ itself.
  const double half = 0.1 * std::exp(0.35 * std::sqrt(2.0 * std::log(2.0)));
  const auto run = [](double magnitude, bool in_set) {
    return json{{"magnitude", magnitude}, {"told_from_none", in_set}, {"in_set", in_set}, {"first", !in_set}};
  };
  json promise = {{"in_set", 0.95}, {"set_size", 2.0}, {"theta_held", 0.9}, {"false_alarms", 0.05}};
  promise["none"] = {{"cases", 10}, {"in_set", 9}};
  promise["effects"]["missing_bridges"] = {
      {"cases", 3}, {"told_from_none", 1}, {"runs", {run(0.1, true), run(half, false), run(-0.1, false)}}};
  promise["effects"]["bead_friction"] = {
      {"cases", 1}, {"told_from_none", 1}, {"runs", {run(0.3, true)}}};  // half as much again as is there
  promise["outside"] = {{"cases", 5}, {"flagged", 4}};
  promise["pairs"] = {{"cases", 4}, {"in_set", 1}, {"first", 0}};
  for (const char* name : {"c1", "c2", "c4", "c5"}) add_to_report(reports / name, {{"promise", promise}});
  const auto all = verdicts(open_seals(folder / "split"), reports);
  EXPECT_NEAR(all[0].promised_in_set().value(), 2.0 / 3.0, 1e-9);
  EXPECT_FALSE(all[1].promised_in_set());
  EXPECT_FALSE(all[2].promised_in_set());  // its report has no promise
  EXPECT_DOUBLE_EQ(all[3].promised_in_set().value(), 0.9);
  EXPECT_FALSE(all[6].promised_in_set());  // a pair without a report
  EXPECT_NEAR(all[0].promised_first().value(), 1.0 / 3.0, 1e-9);
  EXPECT_FALSE(all[3].promised_first());  // no effect
  EXPECT_DOUBLE_EQ(all[4].promised_flagged().value(), 0.8);
  EXPECT_FALSE(all[0].promised_flagged());
  const Scores s = score(all, false);
  EXPECT_NEAR(s.kept.there.expected, 0.5 * (2.0 / 3.0 + 0.9), 1e-9);
  EXPECT_EQ(s.kept.there.came.of, 2u);
  EXPECT_EQ(s.kept.there.came.hits, 1u);  // c1's
  EXPECT_EQ(s.kept_by_stratum.at(Stratum::none).there.came.hits, 0u);
  std::size_t sets = 0, firsts = 0, outside = 0;
  for (const Bars& bars : s.by_observed) {
    sets += bars.in_set_there.came.of, firsts += bars.first_there.came.of;
    if (bars.flagged_there.came.of == 0) continue;
    outside += bars.flagged_there.came.hits;
    EXPECT_DOUBLE_EQ(bars.flagged_there.expected, 0.8);
  }
  EXPECT_EQ(sets, 2u);
  EXPECT_EQ(firsts, 1u);
  EXPECT_EQ(outside, 1u);
  report(reports / "c7", {claim("missing_bridges+bead_friction", 0.9), claim("none", 0.1)},
         {"missing_bridges+bead_friction"});
  add_to_report(reports / "c7", {{"promise", promise}});
  const auto with_pair = verdicts(open_seals(folder / "split"), reports);
  EXPECT_DOUBLE_EQ(with_pair[6].promised_pairs().value(), 0.25);
  EXPECT_FALSE(with_pair[0].promised_pairs());  // one effect
}

TEST_F(Score, SetsWhatCameBesideWhatWasPromised) {
  const auto promise = [](double in_set, double size) {
    return json{
        {"promise", {{"in_set", in_set}, {"set_size", size}, {"theta_held", 0.9}, {"false_alarms", 0.05}}}};
  };
  add_to_report(reports / "c1", promise(0.96, 2.0));
  add_to_report(reports / "c2", promise(0.94, 3.0));
  add_to_report(reports / "c4", promise(0.95, 4.0));
  add_to_report(reports / "c5", promise(0.95, 9.0));  // an outside mechanism is not replayed
  add_to_report(reports / "c2", {{"unseen",
                                  {{{"effect", "bead_friction"}, {"limit_95", 0.15}},
                                   {{"effect", "platen_tilt"}, {"limit_95", 0.1}}}}});
  const Scores s = scores();
  EXPECT_EQ(s.kept.promises, 3u);
  EXPECT_NEAR(s.kept.promised_in_set, 0.95, 1e-12);
  EXPECT_EQ(s.kept.in_set.hits, 2u);
  EXPECT_EQ(s.kept.in_set.of, 3u);
  EXPECT_NEAR(s.kept.promised_size, 3.0, 1e-12);
  EXPECT_NEAR(s.kept.set_size, 4.0 / 3.0, 1e-12);
  EXPECT_EQ(s.kept_by_stratum.at(Stratum::none).promises, 1u);
  EXPECT_EQ(s.kept.unknown_alarms.of, 4u);  // c1 to c4
  EXPECT_EQ(s.kept.unknown_alarms.hits, 0u);
  EXPECT_EQ(s.kept.limits.of, 1u);    // the tilt is not there
  EXPECT_EQ(s.kept.limits.hits, 0u);  // 0.2 is above 0.15
  EXPECT_EQ(s.kept_by_stratum.at(Stratum::library).magnitude.covered.of, 2u);
}

TEST_F(Score, SetsWhatWasClosedBesideWhatTheTruthCloses) {
  write_text(reports / "c1" / kOracle, R"({"fraction": 0.9})");
  write_text(reports / "c2" / kOracle, R"({"fraction": 0.8})");
  const Scores s = scores();
  EXPECT_EQ(s.shrinkage.oracles, 2u);
  EXPECT_NEAR(s.shrinkage.closable, 0.85, 1e-12);
  EXPECT_EQ(s.shrinkage.reached.hits, 1u);  // 0.8 of 0.9, but 0.4 of 0.8
  write_text(reports / "c2" / kOracle, R"({"fraction": null, "nothing_to_close": true})");
  EXPECT_EQ(scores().shrinkage.oracles, 1u);
}

TEST_F(Score, AveragesLogAndBrierScores) {
  const Scores s = scores();
  const double logs = std::log(0.8) + std::log(0.3) + std::log(0.9) + std::log(0.05) + std::log(0.7) +
                      std::log(0.08) + std::log(kLeastProbability);
  EXPECT_NEAR(s.all.log_score, -logs / 7.0, 1e-12);
  const double briers = (0.04 + 0.04) + (0.49 + 0.36 + 0.01) + (0.01 + 0.01) + (0.9025 + 0.9025) +
                        (0.09 + 0.09) + (0.8464 + 0.8464) + 2.0;
  EXPECT_NEAR(s.all.brier, briers / 7.0, 1e-12);
  // Priors: none 0.2, unknown 0.15, nineteen effects 0.5, their pairs 0.15.
  const double prior = 2 * std::log(0.5 / 19) + 2 * std::log(0.2) + 2 * std::log(0.15) + std::log(0.15 / 171);
  EXPECT_NEAR(s.prior_log_score, -prior / 7.0, 1e-9);
}

TEST_F(Score, KnowsAlarmsAndTheUnknown) {
  const Scores s = scores();
  EXPECT_EQ(s.false_alarms.hits, 1u);
  EXPECT_EQ(s.false_alarms.of, 2u);
  EXPECT_EQ(s.flagged.hits, 1u);
  EXPECT_EQ(s.flagged.of, 2u);
  EXPECT_EQ(s.misnamed.hits, 1u);
  // 0.7 and 0.08 against 0, 0.1, 0.1, 0 and the missing one's 0.
  EXPECT_DOUBLE_EQ(s.auroc_unknown, (5.0 + 3.0) / 10.0);
}

TEST_F(Score, MeasuresMagnitudesAndShrinkage) {
  const Scores s = scores();
  EXPECT_NEAR(s.magnitude.median_relative_error, 0.3, 1e-12);  // of 0.1 and 0.5
  EXPECT_EQ(s.magnitude.covered.hits, 1u);
  EXPECT_EQ(s.magnitude.covered.of, 2u);
  EXPECT_NEAR(s.magnitude_where_named.median_relative_error, 0.1, 1e-12);
  EXPECT_EQ(s.shrinkage.cases, 2u);
  EXPECT_NEAR(s.shrinkage.withheld, 0.6, 1e-12);
  EXPECT_NEAR(s.shrinkage.above_retuned, 0.35, 1e-12);
}

TEST_F(Score, SortsProbabilitiesIntoBins) {
  const auto bins = scores().kept.reliability;
  const auto& last = bins.back();
  EXPECT_EQ(last.right.of, 3u);  // 0.9, 0.95, 0.92
  EXPECT_EQ(last.right.hits, 1u);
  EXPECT_NEAR(last.mean_probability, (0.9 + 0.95 + 0.92) / 3.0, 1e-12);
}

TEST_F(Score, WithTheTrueEffectLeftOutUnknownIsRight) {
  mark_without_truth(reports);
  const Scores s = scores();
  EXPECT_TRUE(s.without_truth);
  EXPECT_EQ(s.cases, 3u);  // c1, c2, c7
  EXPECT_EQ(s.all.exact.hits, 0u);
  EXPECT_EQ(s.flagged.of, 3u);
}

TEST_F(Score, PairsAreTheSameInEitherOrder) {
  report(reports / "c7", json::array({claim("bead_friction+missing_bridges", 1.0)}),
         {"bead_friction+missing_bridges"});
  EXPECT_EQ(scores().all.exact.hits, 4u);
}

TEST_F(Score, ReportsThatCannotBeReadAreFailures) {
  write_text(reports / "c1" / "diagnosis.json", "{\"hypotheses\": [");
  write_text(reports / "c3" / "diagnosis.json", "{\"hypotheses\": [{\"id\": 3}]}");
  const Scores s = scores();
  EXPECT_EQ(s.failed, 3u);
  EXPECT_EQ(s.all.exact.hits, 1u);
}

TEST_F(Score, ABrokenSealIsAnError) {
  const fs::path sealed = folder / "split" / "sealed" / "c2.json";
  write_text(sealed, read_text(sealed) + " ");
  try {
    open_seals(folder / "split");
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("c2.json"), std::string::npos);
  }
  fs::remove(sealed);
  EXPECT_THROW(open_seals(folder / "split"), BadInput);
}

TEST_F(Score, ReportsMustBeThere) {
  EXPECT_THROW(verdicts(open_seals(folder / "split"), folder / "nowhere"), BadInput);
}

}  // namespace pendular::blind
