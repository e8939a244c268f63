#include "diagnosis/diagnose.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "effects/list.h"
#include "sample_file.h"
#include "scratch.h"
#include "toy_runs.h"

namespace pendular::diagnosis {
namespace {

using pendular::test::ScratchFolder;

/// Something that the toy stands for, observed and diagnosed with the toy as simulation.
class Diagnose : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder / "sample.toml", pendular::test::sample_file(test::kToySample));
    truth = read_sample(folder / "sample.toml");
  }

  void observe_coordination(double z) {
    write_text(folder / "z.csv", fmt::format("z,z_sigma\n{},0.03\n", z));
    further += "[[observation]]\nkind = \"coordination\"\nname = \"Z\"\nfile = \"z.csv\"\n";
  }

  /// A curve with strains of a machine that gives way, of the toy's 2 mm² and 2 mm.
  std::string read_by_the_machine(const std::string& curve) const {
    std::istringstream lines(curve);
    std::string text, line;
    std::getline(lines, text);
    text += '\n';
    while (std::getline(lines, line)) {
      const std::size_t first = line.find(',');
      const double strain = std::stod(line), stress = std::stod(line.substr(first + 1));
      text += fmt::format("{}{}\n", strain + 1e-9 * compliance * stress, line.substr(first));
    }
    return text;
  }

  Diagnosis diagnosed() {
    write_text(folder / "A.csv", read_by_the_machine(nature.curve_text(truth, 999)));
    write_text(folder / "experiment.toml",
               "[experiment]\nname = \"toy\"\nsample = \"sample.toml\"\n"
               "[uncertainty]\n\"bridges.youngs_modulus_pa\" = 4.5e4\n"
               "[[observation]]\nkind = \"compression\"\nname = \"A\"\nfile = \"A.csv\"\n" +
                   further);
    const Experiment experiment = read_experiment(folder / "experiment.toml");
    const fs::path beads = folder / "beads";
    BankOptions options;
    options.runs = further_runs;
    options.leave_out = leave_out;
    options.levels = levels;
    const MakeRuns make_runs = [&](const std::string& name, std::span<const sweep::RunRequest> requests) {
      (cause.empty() ? before_cause : after_cause) += requests.size();
      return simulation(name, requests);
    };
    return diagnose(experiment, plan_bank(experiment, options, beads), beads, make_runs, rules,
                    {.say_cause = [&](const std::string& words) { cause = words; }});
  }

  ScratchFolder folder;
  Sample truth;
  std::string further, cause;
  std::size_t before_cause = 0, after_cause = 0;  ///< runs
  Rules rules;
  int further_runs = BankOptions().runs;
  std::set<std::string> leave_out;
  int levels = BankOptions().levels;
  double compliance = 0.0;  ///< of the machine that reads the curve, um/N
  test::ToyRuns simulation{folder / "runs"}, nature{folder / "nature"};
};

double probability(const Diagnosis& diagnosis, const std::string& id) {
  for (const auto& e : diagnosis.explanations)
    if (e.id == id) return e.probability;
  return -1.0;
}

}  // namespace

TEST_F(Diagnose, NamesWhatWasWithheldAndClosesTheGap) {
  truth.effects["missing_bridges"] = 0.12;
  observe_coordination(test::ToyRuns::coordination(truth));
  const Diagnosis found = diagnosed();
  const Explanation& best = found.explanations.front();
  EXPECT_EQ(best.id, "missing_bridges");
  // With an effect that acts nowhere it explains as much: those pairs share the rest.
  EXPECT_GT(best.probability, 0.5);
  // No other effect does the same.
  EXPECT_EQ(found.ambiguity_set, (std::vector<std::string>{"missing_bridges"}));
  double not_run = 0.0;  // pairs, which no run has
  for (const auto& e : found.explanations)
    if (e.id == kOtherPairs) not_run = e.probability;
  EXPECT_GT(found.explanations.front().probability, 3.0 * not_run);
  EXPECT_GT(found.set_probability + not_run, 0.9);
  EXPECT_NEAR(best.magnitudes.front().mean, 0.12, 0.015);
  EXPECT_LT(best.magnitudes.front().interval_90.first, 0.12);
  EXPECT_GT(best.magnitudes.front().interval_90.second, 0.12);
  EXPECT_GT(found.fitted.before, 2.0);
  EXPECT_GT(found.fitted.fraction, 0.7);
  // What it is stands before it is checked how far that closes the gap.
  EXPECT_NE(cause.find("missing_bridges"), std::string::npos);
  EXPECT_TRUE(found.verdict.starts_with(cause + " ")) << found.verdict;
  EXPECT_GT(before_cause, after_cause);
  EXPECT_GT(after_cause, 0u);
  // Both are of the same features.
  EXPECT_EQ(found.fitted.before, found.withheld.before);
  EXPECT_EQ(found.fitted.observations, found.withheld.observations);
  // What is true closes as much, and something else does not.
  const Experiment experiment = read_experiment(folder / "experiment.toml");
  const fs::path beads = folder / "beads";
  const auto close = [&](const Changes& changes) {
    return closed_by(experiment, plan_bank(experiment, {}, beads), beads, std::ref(simulation), changes);
  };
  const Shrinkage truth_closes = close({{"missing_bridges", 0.12}});
  EXPECT_EQ(truth_closes.observations, found.fitted.observations);
  EXPECT_NEAR(truth_closes.before, found.fitted.before, 0.3 * found.fitted.before);
  EXPECT_GT(truth_closes.fraction, 0.7);
  EXPECT_LT(close({{"bead_friction", 0.1}}).fraction, 0.3);
}

TEST_F(Diagnose, PromisesWhatReplayedRunsShowForAnyNumberOfThreads) {
  truth.effects["missing_bridges"] = 0.12;
  const Diagnosis parallel = diagnosed();
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const Diagnosis serial = diagnosed();
  EXPECT_GT(parallel.promise.cases, 100u);
  // Most effects do nothing to the toy: none stands for them.
  EXPECT_GE(parallel.promise.in_set, 0.93);
  EXPECT_FALSE(parallel.promise.correction.told_from.at("residual_stress").tells(0.15));
  EXPECT_TRUE(parallel.promise.correction.told_from.at("missing_bridges").tells(0.12));
  EXPECT_NEAR(parallel.promise.theta_held, 0.9, 0.05);
  EXPECT_LT(parallel.promise.false_alarms, 0.1);
  EXPECT_EQ(parallel.promise.pairs.cases, serial.promise.pairs.cases);
  EXPECT_EQ(parallel.promise.pairs.in_set, serial.promise.pairs.in_set);
  EXPECT_EQ(parallel.promise.set_size, serial.promise.set_size);
  EXPECT_EQ(parallel.promise.correction.level, serial.promise.correction.level);
  EXPECT_EQ(parallel.promise.correction.widening, serial.promise.correction.widening);
  ASSERT_EQ(parallel.explanations.size(), serial.explanations.size());
  for (std::size_t k = 0; k < serial.explanations.size(); ++k)
    EXPECT_EQ(parallel.explanations[k].probability, serial.explanations[k].probability);
}

TEST_F(Diagnose, PromisesPairsThatArePutTogetherFromRuns) {
  // One shows in the coordination number and the line, the other after the line.
  const std::set<std::string> shown = {"missing_bridges", "bead_friction"};
  for (const auto& effect : effects::all_effects())
    if (!shown.contains(effect.id)) leave_out.insert(effect.id);
  levels = 6;
  observe_coordination(test::ToyRuns::coordination(truth));
  const Promise promise = diagnosed().promise;
  ASSERT_GT(promise.cases, 0u);
  const PairReplay& pairs = promise.pairs;
  EXPECT_GE(pairs.cases, 8u);
  EXPECT_GE(4 * pairs.in_set, 3 * pairs.cases);
  EXPECT_GE(2 * pairs.first, pairs.cases);
}

// A polymer stiffer than believed by two standard deviations, of which missing bridges make more than by
// itself. Responses that are learnt apart leave that over; runs of both together have it.
TEST_F(Diagnose, RunsWhatLeadsWithWhatIsBelievedAsItFits) {
  truth.effects["missing_bridges"] = 0.15;
  truth.bridges.youngs_modulus += 2.0 * 4.5e4;
  observe_coordination(test::ToyRuns::coordination(truth));
  simulation.interplay = nature.interplay = 20.0;
  const auto left = [](const Diagnosis& diagnosis) {
    for (const auto& e : diagnosis.explanations)
      if (e.id == "missing_bridges") return e.reduced_chi_squared;
    return 0.0;
  };
  const Diagnosis found = diagnosed();
  further_runs = 0;
  const Diagnosis without = diagnosed();
  EXPECT_EQ(found.explanations.front().id, "missing_bridges");
  EXPECT_GT(probability(found, "missing_bridges"), probability(without, "missing_bridges"));
  EXPECT_LT(left(found), 0.5 * left(without));
}

TEST_F(Diagnose, ListsEveryEffectAndSumsToOne) {
  const Diagnosis found = diagnosed();
  double sum = 0.0;
  for (const auto& e : found.explanations) sum += e.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  for (const auto& effect : effects::all_effects())
    EXPECT_GE(probability(found, effect.id), 0.0) << effect.id;
  EXPECT_GE(probability(found, "unknown"), 0.0);
}

TEST_F(Diagnose, SaysNothingIsMissingWhereNothingIs) {
  observe_coordination(test::ToyRuns::coordination(truth));
  const Diagnosis found = diagnosed();
  EXPECT_EQ(found.explanations.front().id, "none");
  EXPECT_EQ(found.fitted.fraction, 0.0);
}

// A gauge on the specimen reads true strains, the machine those of its own frame as well: 7 um/N on 2 mm²
// and 2 mm. Read by the machine, the gauge's ratio would be a tenth too small.
TEST_F(Diagnose, FreshRunsTakeStrainsAsTheyAreReadBest) {
  nature.lateral_ratio = simulation.lateral_ratio = 0.6;
  std::string gauge = "strain,lateral_strain,sigma\n";
  for (int k = 1; k <= 50; ++k) gauge += fmt::format("{},{},1e-4\n", 0.001 * k, 0.0006 * k);
  write_text(folder / "gauge.csv", gauge);
  further += "[[observation]]\nkind = \"lateral_strain\"\nname = \"gauge\"\nfile = \"gauge.csv\"\n";
  compliance = 7.0;
  rules.priors.misfit.odds = 0.0;  // what is left of the toy's replays is less than that of any experiment
  const Diagnosis found = diagnosed();
  const Explanation& best = found.explanations.front();
  ASSERT_EQ(best.id, "machine_compliance");
  EXPECT_NEAR(best.magnitudes.front().mean, 7.0, 1.0);
  EXPECT_EQ(found.specimen_strains, (std::vector<std::string>{"gauge"}));
  EXPECT_NE(found.verdict.find("Strains of gauge are taken as the specimen's own"), std::string::npos);
  EXPECT_GT(found.fitted.fraction, 0.9);
  EXPECT_GT(found.withheld.fraction, 0.9);
  const Columns &curve_repaired = found.overlays.at(0).repaired.at(0),
                &gauge_repaired = found.overlays.at(1).repaired.at(0);
  EXPECT_LT(gauge_repaired.at("strain").back(), curve_repaired.at("strain").back());
  EXPECT_NEAR(gauge_repaired.at("lateral_strain").back() / gauge_repaired.at("strain").back(), 0.6, 1e-9);
}

TEST_F(Diagnose, KnowsThatItDoesNotKnow) {
  // Half as stiff with more bridges than there can be: no effect of the library does that.
  nature.unexplained = 0.5;
  observe_coordination(8.6);
  const Diagnosis found = diagnosed();
  EXPECT_EQ(found.explanations.front().id, "unknown") << found.verdict;
}

TEST_F(Diagnose, CountsAndTellsFailedRuns) {
  simulation.failing = {"bead_friction"};
  const Diagnosis found = diagnosed();
  const auto failed = std::count_if(found.ledger.begin(), found.ledger.end(),
                                    [](const LedgerRow& row) { return row.status == "failed"; });
  EXPECT_GE(failed, 3);
  EXPECT_NE(found.verdict.find(fmt::format("{} of {} simulations failed", failed, found.ledger.size())),
            std::string::npos)
      << found.verdict;
}

TEST_F(Diagnose, WithoutAnyBaselineThereIsNone) {
  class Failing {
   public:
    std::vector<sweep::RunOutcome> operator()(const std::string&,
                                              std::span<const sweep::RunRequest> requests) {
      sweep::RunOutcome failed;
      failed.status = sweep::RunStatus::failed;
      failed.message = "it fell apart";
      return std::vector<sweep::RunOutcome>(requests.size(), failed);
    }
  };
  write_text(folder / "A.csv", nature.curve_text(truth, 999));
  write_text(folder / "experiment.toml",
             "[experiment]\nname = \"toy\"\nsample = \"sample.toml\"\n"
             "[[observation]]\nkind = \"compression\"\nname = \"A\"\nfile = \"A.csv\"\n");
  const Experiment experiment = read_experiment(folder / "experiment.toml");
  EXPECT_THROW(diagnose(experiment, plan_bank(experiment, {}, folder / "beads"), folder / "beads", Failing()),
               ComputationFailed);
}

}  // namespace pendular::diagnosis
