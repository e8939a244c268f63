#include "diagnosis/bank/bank.h"
#include "diagnosis/bank/law_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "diagnosis/experiment/specimens.h"
#include "measured_beads.h"
#include "observations.h"
#include "packing/tables.h"
#include "scratch.h"

namespace pendular::diagnosis {
namespace {

Experiment one_compression() {
  Experiment experiment;
  experiment.name = "small";
  experiment.sample.specimen.diameter = experiment.sample.specimen.height = 1e-3;
  Observation curve;
  curve.name = "A";
  curve.columns = {{"strain", {0.0, 0.02, 0.04}}, {"stress_pa", {0.0, 2e5, 5e5}}};
  experiment.observations = {curve};
  experiment.uncertainty = {{"bridges.youngs_modulus_pa", 1.5e5}, {"bridges.poisson_ratio", 0.02}};
  return experiment;
}

std::set<double> magnitudes(const BankPlan& plan, const std::string& id) {
  std::set<double> found;
  for (const auto& point : plan.points)
    if (point.id == id) found.insert(point.theta);
  return found;
}

TEST(Bank, RunsEveryEffectAtPartsOfItsRangeAndInBothDirections) {
  const BankPlan plan = plan_bank(one_compression(), {}, "beads");
  EXPECT_EQ(plan.runs.size(), plan.requests.size());
  EXPECT_EQ(magnitudes(plan, "missing_bridges").size(), 3u);
  EXPECT_NEAR(*magnitudes(plan, "missing_bridges").rbegin(), 0.3, 1e-12);
  EXPECT_EQ(magnitudes(plan, "bridge_bending").size(), 6u);  // does not draw
  const auto friction = magnitudes(plan, "bead_friction");
  EXPECT_EQ(friction.size(), 8u);
  EXPECT_NEAR(*friction.begin(), -0.4, 1e-12);
  EXPECT_NEAR(*friction.upper_bound(0.0), 0.1, 1e-12);
  EXPECT_TRUE(magnitudes(plan, "machine_compliance").empty());  // is read off the baselines
  EXPECT_TRUE(plan.absent.contains("funicular_bridges"));       // no polymer above W*
  std::set<int> members;
  for (const auto& point : plan.points) members.insert(point.member);
  EXPECT_EQ(members.size(), 6u);
}

TEST(Bank, RunsTheOtherReadingsOfTheLaw) {
  const Experiment experiment = one_compression();
  const BankPlan plan = plan_bank(experiment, {}, "beads");
  for (const auto& reading : law_readings()) {
    EXPECT_EQ(magnitudes(plan, reading.id), std::set<double>{1.0}) << reading.id;
    Sample other = plan.conditions.front().sample;
    reading.other(other);
    const auto asked = std::find_if(plan.points.begin(), plan.points.end(),
                                    [&](const auto& p) { return p.id == reading.id; });
    EXPECT_EQ(sample_text(changed_condition(experiment, plan.conditions.front(), asked->changes)),
              sample_text(other));
    EXPECT_NE(sample_text(other), sample_text(plan.conditions.front().sample));
    reading.other(other);
    EXPECT_EQ(sample_text(other), sample_text(plan.conditions.front().sample));
  }
}

/// How often a magnitude of an effect is run, in all tests and in those that end at a scan.
std::pair<int, int> draws_of(const BankPlan& plan, const std::string& id) {
  std::pair<int, int> count = {0, 0};
  const double first = *magnitudes(plan, id).begin();
  for (const auto& point : plan.points)
    if (point.id == id && point.theta == first) ++count.second, count.first += !point.scans_only;
  return count;
}

TEST(Bank, EffectsThatDrawAreDrawnAgain) {
  const BankPlan plan = plan_bank(one_compression(), {}, "beads");
  std::set<std::uint64_t> seeds;
  for (const auto& point : plan.points)
    if (point.id == "missing_bridges" && point.theta == *magnitudes(plan, "missing_bridges").begin())
      seeds.insert(point.seed);
  EXPECT_EQ(draws_of(plan, "missing_bridges"), std::pair(3, 3));
  EXPECT_EQ(seeds.size(), 3u);
  EXPECT_EQ(draws_of(plan, "bridge_bending"), std::pair(1, 1));
}

TEST(Bank, AScanOfMeasuredBeadsIsRunTwiceAsOften) {
  pendular::test::ScratchFolder folder;
  Experiment experiment = one_compression();
  experiment.sample = pendular::test::touching_sample();
  experiment.uncertainty.clear();
  write_beads(folder / "beads.csv", pendular::test::measured_beads(), {});
  experiment.observations[0].beads = folder / "beads.csv";
  experiment.observations.push_back(
      test::observation(kinds::displacements(), "scan", {{"strain", {0.01, 0.01}}, {"bead_id", {1, 2}}}));
  experiment.observations[1].beads = folder / "beads.csv";
  const BankPlan plan = plan_bank(experiment, {}, folder / "moved");
  ASSERT_EQ(plan.conditions.size(), 2u);
  EXPECT_EQ(std::count_if(plan.conditions.begin(), plan.conditions.end(), ends_at_scan), 1);
  std::set<int> members, of_curves;
  for (const auto& [point, condition] : plan.runs) {
    if (!plan.points[point].id.empty()) continue;
    members.insert(plan.points[point].member);
    if (!ends_at_scan(plan.conditions[condition])) of_curves.insert(plan.points[point].member);
  }
  EXPECT_EQ(of_curves.size(), 12u);  // beads moved by their errors
  EXPECT_EQ(members.size(), 48u);
  EXPECT_EQ(draws_of(plan, "missing_bridges"), std::pair(3, 6));
  EXPECT_EQ(draws_of(plan, "bridge_bending"), std::pair(1, 1));
}

TEST(Bank, LeavesOutWhatItIsAsked) {
  const BankPlan plan = plan_bank(one_compression(), {3, {"missing_bridges"}}, "beads");
  EXPECT_TRUE(magnitudes(plan, "missing_bridges").empty());
  EXPECT_TRUE(plan.absent.contains("missing_bridges"));
}

TEST(Bank, WithoutAnEffectHasTheOtherRunsOfTheWholeLibrary) {
  const BankPlan all = plan_bank(one_compression(), {}, "beads");
  std::set<std::string> others;
  for (std::size_t k = 0; k < all.requests.size(); ++k)
    if (all.points[all.runs[k].point].id != "missing_bridges")
      others.insert(sweep::content_hash(all.requests[k]));
  std::set<std::string> found;
  for (const auto& request : plan_bank(one_compression(), {3, {"missing_bridges"}}, "beads").requests)
    found.insert(sweep::content_hash(request));
  EXPECT_EQ(found, others);
}

TEST(Bank, LargeSpecimensLearnOnSmallerOnesOfTheSameShape) {
  Experiment experiment = one_compression();
  experiment.sample.specimen.diameter = 4.25e-3, experiment.sample.specimen.height = 4.05e-3;
  const BankPlan plan = plan_bank(experiment, {}, "beads");
  for (std::size_t k = 0; k < plan.requests.size(); ++k) {
    const auto& specimen = plan.requests[k].sample.specimen;
    EXPECT_NEAR(specimen.height / specimen.diameter, 4.05 / 4.25, 1e-9);
    EXPECT_EQ(plan.points[plan.runs[k].point].whole, specimen.diameter == 4.25e-3);
    const DesignPoint& point = plan.points[plan.runs[k].point];
    if (point.whole || point.id == "specimen.volume_fraction") continue;
    EXPECT_NEAR(beads_in({plan.requests[k].sample, {}, {}}), 1500.0, 1.0);
  }
  // Roughness is a length of the ends: it shrinks with the specimen.
  for (const auto& request : plan.requests) {
    const auto found = request.sample.effects.find("platen_roughness");
    if (found == request.sample.effects.end()) continue;
    EXPECT_LE(found->second, 40.0 * request.sample.specimen.diameter / 4.25e-3 + 1e-9);
  }
}

TEST(Bank, BelievedInputsMoveInSharesAndStopAtTheirRange) {
  const Experiment experiment = one_compression();
  Condition condition{experiment.sample, {}, {0}};
  condition.sample.bridges.youngs_modulus = 3e6;  // another polymer, twice the believed one
  const Sample stiffer = changed_condition(experiment, condition, {{"bridges.youngs_modulus_pa", 2.0}});
  EXPECT_NEAR(stiffer.bridges.youngs_modulus, 3.6e6, 1.0);
  const Sample limit = changed_condition(experiment, condition, {{"bridges.poisson_ratio", 2.0}});
  EXPECT_LT(limit.bridges.poisson_ratio, 0.5);
  const auto floating = floating_inputs(experiment);
  EXPECT_TRUE(floating.contains("specimen.volume_fraction"));  // beads were not measured
}

}  // namespace
}  // namespace pendular::diagnosis
