#include "blind/case_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "blind/truth.h"
#include "blind/verdict.h"
#include "diagnosis/experiment/conditions.h"
#include "diagnosis/kinds/curve_signature.h"
#include "scratch.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

using pendular::test::ScratchFolder;
using test::files_in;

/// A small split with its three cases made, once for all tests.
class Case : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    split = new Split(test::small_split());
    root = fs::temp_directory_path() / fmt::format("pendular.blind_cases.{}", ::getpid());
    for (const auto& plan : plan_of(*split)) make_case({root}, *split, plan);
  }
  static void TearDownTestSuite() {
    fs::remove_all(root);
    delete split;
  }
  static CaseFolders folders() { return {root}; }
  static Split* split;
  static fs::path root;
};
Split* Case::split = nullptr;
fs::path Case::root;

}  // namespace

TEST_F(Case, IsAnExperimentThatNeedsNoTruth) {
  ScratchFolder elsewhere;
  fs::copy(root / "cases", elsewhere / "cases", fs::copy_options::recursive);
  for (const auto& plan : plan_of(*split)) {
    const auto experiment = diagnosis::read_experiment(elsewhere / "cases" / plan.name / "experiment.toml");
    EXPECT_EQ(experiment.observations.size(), 1 + plan.short_specimen() + plan.kinds.size() + plan.scanned() +
                                                  plan.bridges_at_rest + plan.bridges_under_load);
    EXPECT_TRUE(experiment.warnings.empty());
    const auto& a = experiment.observations.front();
    const auto turns = diagnosis::unloading_strains({a.column("strain"), a.column("stress_pa")});
    ASSERT_EQ(turns.size(), 1u);
    EXPECT_DOUBLE_EQ(turns[0], split->unload_at);
    EXPECT_DOUBLE_EQ(*std::max_element(a.column("strain").begin(), a.column("strain").end()),
                     split->max_strain);
  }
}

TEST_F(Case, SpecimensAndBeliefsAreTheSameWhateverIsTrue) {
  const auto plans = plan_of(*split);
  for (const char* file : {"sample.toml", "A_beads.csv"}) {
    const std::string first = pendular::test::content(folders().open(plans[0].name) / file);
    EXPECT_FALSE(first.empty());
    for (const auto& plan : plans)
      EXPECT_EQ(pendular::test::content(folders().open(plan.name) / file), first) << plan.name << file;
  }
  EXPECT_NE(pendular::test::content(folders().open(plans[0].name) / "A.csv"),
            pendular::test::content(folders().open(plans[1].name) / "A.csv"));
}

TEST_F(Case, AsksForTheSameRunsWhateverIsTrue) {
  // What the runs of a diagnosis follow from: of A's condition, in cases with different truths.
  std::vector<std::string> samples;
  for (const auto& plan : plan_of(*split)) {
    const auto conditions =
        diagnosis::conditions_of(diagnosis::read_experiment(folders().open(plan.name) / "experiment.toml"));
    samples.push_back(sample_text(conditions.front().sample));
  }
  for (const auto& sample : samples) EXPECT_EQ(sample, samples.front());
}

TEST_F(Case, NothingInTheOpenTellsTheTruth) {
  for (const auto& plan : plan_of(*split)) {
    const auto open = files_in(folders().open(plan.name));
    for (const auto& [name, text] : open) {
      if (name == "seal.txt") continue;
      for (const std::string& word : {to_string(plan.stratum), plan.salt, plan.mechanism})
        EXPECT_TRUE(word.empty() || word == "none" || text.find(word) == std::string::npos)
            << plan.name << ": " << name << " has " << word;
      // Not by the effects' names: some are also keys of a sample.
      EXPECT_EQ(text.find("effects"), std::string::npos) << plan.name << ": " << name;
      for (const auto& [id, theta] : plan.effects)
        EXPECT_EQ(text.find(fmt::format("{:.6g}", theta)), std::string::npos) << plan.name << ": " << name;
    }
  }
}

TEST_F(Case, ItsSealIsThatOfItsTruth) {
  for (const auto& plan : plan_of(*split)) {
    EXPECT_EQ(published_seal(folders().open(plan.name)), sha256_of(folders().sealed(plan.name)));
    const Truth truth = read_truth(folders().sealed(plan.name));
    EXPECT_EQ(truth.stratum, plan.stratum);
    EXPECT_EQ(truth.answer, right_answer(plan));
    ASSERT_EQ(truth.effects.size(), plan.effects.size());
    for (const auto& [id, theta] : truth.effects) EXPECT_DOUBLE_EQ(theta, plan.effects.at(id));
    EXPECT_EQ(truth.mechanism, plan.mechanism);
  }
}

TEST_F(Case, AnotherSplitsCaseIsRefused) {
  Split other = *split;
  other.content = "another";
  const auto plans = plan_of(*split);
  EXPECT_TRUE(is_made(folders(), *split, plans[0]));
  EXPECT_THROW(is_made(folders(), other, plans[0]), BadInput);
}

TEST_F(Case, MeasuredBeadsAreOffByTheStatedErrors) {
  Sample believed = believed_a(*split, split->packings[0]);
  const Packing actual = reported_beads({}, *split, believed, 3, 0);
  const auto measured = measured_beads(actual, 3, *split);
  double square = 0.0, diameters = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    square += (measured[k].centre - actual.beads[k].centre).squaredNorm() / 3.0;
    diameters += std::pow(measured[k].diameter - actual.beads[k].diameter, 2);
    EXPECT_EQ(measured[k].sigma_centre, split->sigma_centre);
  }
  const double n = static_cast<double>(measured.size());
  EXPECT_NEAR(std::sqrt(square / n), split->sigma_centre, 0.2 * split->sigma_centre);
  EXPECT_NEAR(std::sqrt(diameters / n), split->sigma_diameter, 0.3 * split->sigma_diameter);
}

TEST_F(Case, BeadsAreReportedWithTheErrorThatIsWithheld) {
  const Sample believed = believed_a(*split, split->packings[0]);
  const Packing actual = reported_beads({}, *split, believed, 3, 0);
  for (const auto& [effect, theta] : {std::pair("diameter_bias", 2.0), {"position_error", 3.0}}) {
    CasePlan plan;
    plan.effects = {{effect, theta}};
    const Packing reported = reported_beads(plan, *split, believed, 3, 0);
    const bool bias = effect == std::string("diameter_bias");
    double moved = 0.0, wider = 0.0;
    for (std::size_t k = 0; k < actual.beads.size(); ++k) {
      moved += (reported.beads[k].centre - actual.beads[k].centre).squaredNorm() / 3.0;
      wider += reported.beads[k].diameter - actual.beads[k].diameter;
    }
    const double n = static_cast<double>(actual.beads.size());
    EXPECT_NEAR(std::sqrt(moved / n), bias ? 0.0 : 3e-6, 0.3e-6);
    EXPECT_NEAR(wider / n, bias ? 2e-6 : 0.0, 1e-12);
    // The specimen that is tested has beads that touch.
    const TrueTest test = run_truth(plan, *split, believed, reported, 0, false, 0.0, root / "scratch");
    for (std::size_t k = 0; k < actual.beads.size(); ++k)
      EXPECT_LT((test.packing.beads[k].centre - actual.beads[k].centre).norm(), 1e-12);
  }
}

TEST_F(Case, TruthIsOffTheBeliefByItsOffsets) {
  CasePlan plan;
  plan.offsets = {{"bridges.youngs_modulus_pa", 2.0}};
  const SharedPacking& packing = split->packings[0];
  const double sigma = split->uncertainty.at("bridges.youngs_modulus_pa");
  EXPECT_DOUBLE_EQ(true_sample(plan, *split, believed_a(*split, packing)).bridges.youngs_modulus,
                   1.5e6 + 2.0 * sigma);
  // The other specimen's polymer is off by the same share.
  EXPECT_DOUBLE_EQ(true_sample(plan, *split, believed_b(*split, packing)).bridges.youngs_modulus,
                   4.5e6 + 3.0 * 2.0 * sigma);
  plan.law = "one_spring";
  EXPECT_EQ(true_sample(plan, *split, believed_a(*split, packing)).contact.tangential_springs,
            TangentialSprings::one);
}

}  // namespace pendular::blind
