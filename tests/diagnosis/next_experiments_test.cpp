#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/advice/planning.h"
#include "diagnosis/bank/bank_tests.h"
#include "diagnosis/bank/feature_values.h"
#include "diagnosis/diagnose.h"
#include "diagnosis/experiment/further_measurements.h"
#include "diagnosis/kinds/kind.h"
#include "effects/list.h"
#include "sample_file.h"
#include "scratch.h"
#include "toy_runs.h"

namespace pendular::diagnosis {
namespace {

using pendular::test::ScratchFolder;

const NextExperiment* found(const NextSteps& steps, const std::string& start) {
  for (const auto& next : steps.experiments)
    if (next.observation.starts_with(start)) return &next;
  return nullptr;
}

class Planning : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder / "sample.toml", pendular::test::sample_file(test::kToySample));
    beliefs = *read_beliefs(folder / "sample.toml");
    // Of few beads.
    auto& specimen = beliefs.sample.specimen;
    specimen.diameter = specimen.height = 1.2e-3, specimen.volume_fraction = 0.55;
    beliefs.uncertainty["bridges.youngs_modulus_pa"] = 1.5e5;
  }

  /// A plan of a specimen whose beads the toy does not need.
  Experiment planned() {
    Experiment experiment = planned_experiment(beliefs, folder / "beads");
    experiment.observations.front().beads.clear();
    experiment.contacts.reset();
    return experiment;
  }

  /// A bank of few effects, of which two act on the toy.
  BankPlan bank_of(const Experiment& experiment) {
    BankOptions options;
    for (const auto& effect : effects::all_effects())
      if (!std::set<std::string>{"missing_bridges", "bead_friction", "residual_stress"}.contains(effect.id))
        options.leave_out.insert(effect.id);
    return plan_bank(experiment, options, folder / "beads");
  }

  /// Such a bank, run by the toy.
  struct ToyBank {
    explicit ToyBank(Planning& of)
        : experiment(of.planned()),
          plan(of.bank_of(experiment)),
          make_runs(std::ref(of.simulation)),
          packings(of.folder / "beads") {
      bank.make("bank", plan);
    }

    NextSteps steps(const Question& question, const MakeRuns* runs, double farthest) {
      return next_steps({experiment, plan, bank.tests(), packings, runs, farthest, {}, 0.95, 0}, question,
                        ledger);
    }

    Experiment experiment;
    BankPlan plan;
    MakeRuns make_runs;
    MemberPackings packings;
    std::vector<LedgerRow> ledger = {};
    BankTests bank{make_runs, ledger};
  };

  ScratchFolder folder;
  Experiment beliefs;
  test::ToyRuns simulation{folder / "runs"};
};

}  // namespace

TEST_F(Planning, EveryMeasurementReadsSomething) {
  const Experiment planned = planned_experiment(beliefs, folder / "beads");
  std::size_t added = 0;
  for (const auto& measurement : further_measurements()) {
    EXPECT_GT(measurement.cost, 0.0) << measurement.name;
    EXPECT_EQ(measurement.added == nullptr, !measurement.settles.empty()) << measurement.name;
    if (!measurement.added) continue;
    const auto more = measurement.added(planned);
    ASSERT_TRUE(more) << measurement.name;
    ++added;
    ASSERT_EQ(more->observations.size(), planned.observations.size() + 1);
    const Observation& observation = more->observations.back();
    const bool reads = observation.kind->field != nullptr ||
                       !features_of(Level::readings, observation, observation.columns).empty();
    EXPECT_TRUE(reads) << measurement.name;
    EXPECT_FALSE(measurement.added(*more) && !measurement.name.starts_with("a second scan") &&
                 observation.kind != compression_kind())
        << measurement.name << " is offered where it is there";
  }
  EXPECT_GE(added, 12u);
}

TEST_F(Planning, BridgesCountedTellMissingOnesFromASofterPolymer) {
  const Experiment experiment = planned();
  const BankPlan plan = bank_of(experiment);
  std::vector<LedgerRow> ledger;
  const auto steps = plan_experiments(experiment, plan, folder / "beads", std::ref(simulation),
                                      {"missing_bridges"}, {}, ledger);
  ASSERT_GT(steps.now.cases, 60u);
  const NextExperiment* counted = found(steps, "bridges per bead");
  ASSERT_NE(counted, nullptr);
  // What is left is of the effect that does nothing to the toy.
  EXPECT_LT(counted->outlook.entropy, steps.now.entropy - 0.15);
  EXPECT_LT(counted->outlook.set_size, steps.now.set_size);
  const auto& now = steps.now.effects.at("missing_bridges");
  const auto& then = counted->outlook.effects.at("missing_bridges");
  EXPECT_GT(then.first, now.first);
  // Nothing acts on what the toy breaks.
  EXPECT_EQ(found(steps, "acoustic"), nullptr);
  const auto value = [&](const NextExperiment& next) {
    return (next.outlook.settled - steps.now.settled + 0.1 * next.gain) / (2.0 + next.cost);
  };
  for (std::size_t k = 1; k < steps.experiments.size(); ++k)
    EXPECT_GE(value(steps.experiments[k - 1]), value(steps.experiments[k]));
}

TEST_F(Planning, TestsThatTheBankLacksAreRunAsFarAsIsAllowed) {
  ToyBank toy(*this);
  const Question question = question_before(toy.plan, {"missing_bridges"});
  const std::size_t before = toy.ledger.size();
  const double course = toy.plan.conditions.front().sample.compression.max_strain;
  for (const auto& steps :
       {toy.steps(question, nullptr, kAnyStrain), toy.steps(question, &toy.make_runs, 0.9 * course)}) {
    EXPECT_EQ(toy.ledger.size(), before);
    ASSERT_NE(found(steps, "bridges per bead"), nullptr);
    EXPECT_EQ(found(steps, "bridges per bead")->runs, 0u);
    ASSERT_NE(found(steps, "a specimen of half the height"), nullptr);
    EXPECT_GT(found(steps, "a specimen of half the height")->runs, 30u);
    EXPECT_EQ(steps.experiments.back().outlook.cases, 0u);
  }
  const auto steps = toy.steps(question, &toy.make_runs, course);
  EXPECT_GT(toy.ledger.size(), before + 30);
  for (const auto& next : steps.experiments) EXPECT_EQ(next.runs, 0u) << next.observation;
}

TEST_F(Planning, WhatTellsForSureGainsTheEntropyOfWhatItTells) {
  ToyBank toy(*this);
  Question question;
  question.effects = {"missing_bridges", "bead_friction"};
  question.probabilities = {{"none", 0.2}, {"missing_bridges", 0.1}, {"bead_friction", 0.1}};
  const auto before = toy.steps(question, nullptr, 0.0);
  const NextExperiment* slides = found(before, "sliding friction");
  ASSERT_NE(slides, nullptr);
  // A quarter, or three quarters: 1/4 log2 4 + 3/4 log2 4/3.
  EXPECT_NEAR(slides->gain, 0.25 * 2.0 + 0.75 * std::log2(4.0 / 3.0), 1e-12);
  question.probabilities["bead_friction"] = 0.0;
  const auto after = toy.steps(question, nullptr, 0.0);
  EXPECT_EQ(found(after, "sliding friction"), nullptr) << "nothing to tell";
}

TEST(Outlook, WhoKnowsWhatIsThereIsLeftWithTheRest) {
  // a and b look alike; c is told apart.
  std::vector<Replayed> replayed;
  for (int k = 0; k < 120; ++k) {
    Replayed one;
    one.member = 1 + k % 6;
    const std::string truth = k % 3 == 0 ? "a" : k % 3 == 1 ? "b" : "c";
    one.truth[truth] = 1.0;
    for (const char* id : {"a", "b", "c", "none", "unknown"}) {
      const bool alike = (truth == "c") == (std::string(id) == "c");
      const bool effect = std::string(id).size() == 1;
      const double probability = effect && alike ? (truth == "c" ? 0.98 : 0.49) : 0.01;
      Hypothesis h{id, std::log(probability), probability, {}, 0.0};
      if (effect) h.magnitudes = {{1.0, {0.5, 1.5}}};
      one.said.push_back(h);
    }
    std::stable_sort(one.said.begin(), one.said.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
    replayed.push_back(one);
  }
  const auto alike = [](const Replayed&) { return 1.0; };
  const Outlook now = outlook_of(replayed, 0.9, alike);
  const Outlook then = outlook_of(knowing(replayed, {"a"}), 0.9, alike);
  EXPECT_NEAR(now.settled, 1.0 / 3.0, 0.05);
  EXPECT_NEAR(now.set_size, 5.0 / 3.0, 0.4);
  EXPECT_NEAR(then.settled, 1.0, 1e-9);
  EXPECT_NEAR(then.set_size, 1.0, 1e-9);
  EXPECT_LT(then.entropy, now.entropy - 0.5);
  // Only what is in question counts.
  const Outlook of_c =
      outlook_of(replayed, 0.9, [](const Replayed& one) { return one.truth.contains("c") ? 1.0 : 0.0; });
  EXPECT_NEAR(of_c.set_size, 1.0, 1e-9);
}

}  // namespace pendular::diagnosis
