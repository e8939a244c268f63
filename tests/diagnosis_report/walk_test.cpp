#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "diagnosis/diagnose.h"
#include "diagnosis/experiment/further_measurements.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "diagnosis/words.h"
#include "diagnosis_report/report_folder.h"
#include "effects/list.h"
#include "sample_file.h"
#include "scratch.h"
#include "toy_runs.h"

// An effect and a kind of observation that no list of the program names, followed through the diagnosis.

namespace pendular {
namespace {

effects::Effect softness() {
  return {.id = "toy_softness",
          .unit = "fraction",
          .name = "toy of a soft bed",
          .sentence = "A soft bed that only a test knows.",
          .meaning = "share of the stiffness that is lost",
          .lowest = 0.0,
          .highest = 0.9,
          .bank_from = 0.0,
          .bank_to = 0.4,
          .settled_by = effects::DirectMeasurement{"a look at the toy's bed", "the bed by itself", 0.1},
          .sample = [](Sample&, double) {}};  // the toy reads it from the sample
}

/// Twice the bridges per bead.
diagnosis::Kind ends_of_bridges() {
  using namespace diagnosis;
  return {.name = "toy_ends",
          .required = {"ends", "ends_sigma"},
          .scale = Scale::network,
          .usual = UsualMeasurement{"ends of bridges, counted by a toy", "bridges, twice", 0.2},
          .course = [](const Observation&, Sample::Compression&) {},
          .simulate = [](const Observation&, const Simulated& simulated) -> Columns {
            return {{"ends", {2.0 * simulated.test->coordination}}};
          },
          .landmarks =
              [](const Observation& observation, const Columns& columns) {
                FeatureList list(observation, Scale::network);
                list.ratio("ends_per_bead", mean_of(columns.at("ends")));
                return list.take();
              },
          .perturbed =
              [](const Observation& observation, unsigned long seed) {
                Columns columns = observation.columns;
                add_stated_noise(columns, "ends", "ends_sigma", seed);
                return columns;
              },
          .planned = [](const Observation&, const Sample&, double) -> Columns {
            return {{"ends", {12.0}}, {"ends_sigma", {0.1}}};
          },
          .shown = [](const Observation& planned, const Columns& simulated) -> Columns {
            return {{"ends", simulated.at("ends")}, {"ends_sigma", planned.column("ends_sigma")}};
          },
          .model_error =
              [](const std::vector<Feature>& features) {
                return errors_by_name(features, {{"ends_per_bead", 0.01}});
              }};
}

/// A toy specimen with the effect, observed by a curve and by the kind.
class Walk : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder / "sample.toml", test::sample_file(diagnosis::test::kToySample));
    Sample truth = read_sample(folder / "sample.toml");
    truth.effects["toy_softness"] = 0.2;
    write_text(folder / "A.csv", runs.curve_text(truth, 999));
    write_text(folder / "ends.csv", fmt::format("ends,ends_sigma\n{},0.06\n",
                                                2.0 * diagnosis::test::ToyRuns::coordination(truth)));
    write_text(folder / "experiment.toml",
               "[experiment]\nname = \"toy\"\nsample = \"sample.toml\"\n"
               "[uncertainty]\n\"bridges.youngs_modulus_pa\" = 4.5e4\n"
               "[[observation]]\nkind = \"compression\"\nname = \"A\"\nfile = \"A.csv\"\n"
               "[[observation]]\nkind = \"toy_ends\"\nname = \"ends\"\nfile = \"ends.csv\"\n");
  }

  test::ScratchFolder folder;
  diagnosis::test::ToyRuns runs{folder / "runs"};
  const effects::AddedEffect effect{softness()};
  const diagnosis::Kind ends = ends_of_bridges();
  const diagnosis::AddedKind kind{ends};
};

TEST_F(Walk, TheDiagnosisFindsTheEffectByTheKindAndReportsBoth) {
  const auto experiment = diagnosis::read_experiment(folder / "experiment.toml");
  const auto bank = diagnosis::plan_bank(experiment, {}, folder / "beads");
  EXPECT_TRUE(std::any_of(bank.points.begin(), bank.points.end(),
                          [](const auto& point) { return point.id == "toy_softness"; }));
  const auto found = diagnosis::diagnose(experiment, bank, folder / "beads", std::ref(runs));
  EXPECT_EQ(found.explanations.front().id, "toy_softness") << found.verdict;
  EXPECT_NEAR(found.explanations.front().magnitudes.front().mean, 0.2, 0.05);
  EXPECT_NE(found.verdict.find("toy of a soft bed"), std::string::npos) << found.verdict;

  diagnosis_report::write_report_folder(folder / "report", found);
  const std::string page = read_text(folder / "report" / "report.html");
  for (const char* part : {"toy of a soft bed", "A soft bed that only a test knows.", "ends per bead"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "report" / "diagnosis.json"))["hypotheses"][0]["id"],
            "toy_softness");
}

TEST_F(Walk, TheyAreAmongFurtherMeasurements) {
  const auto all = diagnosis::further_measurements();
  const auto named = [&](const std::string& name) {
    return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  };
  ASSERT_NE(named("a look at the toy's bed"), all.end());
  EXPECT_EQ(named("a look at the toy's bed")->settles, (std::set<std::string>{"toy_softness"}));
  ASSERT_NE(named("ends of bridges, counted by a toy"), all.end());
  write_text(folder / "curve_alone.toml",
             "[experiment]\nname = \"toy\"\nsample = \"sample.toml\"\n"
             "[[observation]]\nkind = \"compression\"\nname = \"A\"\nfile = \"A.csv\"\n");
  const auto more = named("ends of bridges, counted by a toy")
                        ->added(diagnosis::read_experiment(folder / "curve_alone.toml"));
  ASSERT_TRUE(more);
  EXPECT_EQ(more->observations.back().kind, &ends);
}

TEST(AddedKind, WhatCannotBeOneIsRefused) {
  using diagnosis::AddedKind;
  diagnosis::Kind kind = ends_of_bridges();
  kind.name = "compression";
  EXPECT_THROW(AddedKind{kind}, BadInput);
  kind = ends_of_bridges(), kind.perturbed = nullptr;
  EXPECT_THROW(AddedKind{kind}, BadInput);
  kind = ends_of_bridges(), kind.shown = nullptr;
  EXPECT_THROW(AddedKind{kind}, BadInput);
  const std::size_t count = diagnosis::all_kinds().size();
  kind = ends_of_bridges();
  {
    const AddedKind added{kind};
    EXPECT_EQ(diagnosis::all_kinds().size(), count + 1);
  }
  EXPECT_EQ(diagnosis::all_kinds().size(), count);
}

}  // namespace
}  // namespace pendular
