#include "blind/mechanism.h"

#include <set>

#include "base/error.h"
#include "blind/truth.h"
#include "packing/statistics.h"
#include "scratch.h"
#include "small_split.h"
#include "specimens.h"

namespace pendular::blind {
namespace {

using pendular::test::ScratchFolder;

/// What a test of 144 beads comes to.
struct Curve {
  std::vector<CurveRow> rows;
  double peak = 0.0;
  double residual = 1.0;  ///< smallest strain after the turn

  double stress_at(double strain) const {
    for (const auto& row : rows)
      if (row.strain >= strain) return row.stress;
    return 0.0;
  }
};

Curve tested(const std::string& mechanism, double theta, double max_strain) {
  Split split = test::small_split();
  split.max_strain = max_strain;
  split.unload_at = 0.5 * max_strain;
  Packing packing = pendular::test::disordered(3, 4);
  packing.specimen = specimen_enclosing(packing.beads);
  Sample sample = split.sample;
  sample.compression.speed = 2e-4;
  CasePlan plan;
  plan.mechanism = mechanism, plan.mechanism_theta = theta;
  ScratchFolder folder;
  Curve curve;
  curve.rows = run_truth(plan, split, sample, packing, 0, true, 0.0, folder / "run").rows;
  double reached = 0.0;
  for (const auto& row : curve.rows) {
    curve.peak = std::max(curve.peak, row.stress);
    reached = std::max(reached, row.strain);
    if (reached < 0.52 * max_strain && reached > 0.49 * max_strain)
      curve.residual = std::min(curve.residual, row.strain);
  }
  return curve;
}

Curve with(const std::string& id, double max_strain) {
  return tested(id, find_mechanism(id, "test").to, max_strain);
}
Curve without(double max_strain) {
  return tested("", 0.0, max_strain);
}

std::vector<CurveRow> rows_of(const std::vector<std::pair<double, double>>& points) {
  std::vector<CurveRow> rows(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    rows[k].strain = points[k].first, rows[k].stress = points[k].second;
  return rows;
}

dem_core::Simulation machine() {
  dem_core::Simulation simulation;
  simulation.initial_height = 2e-3, simulation.section = 2e-6;
  return simulation;
}

}  // namespace

TEST(Mechanism, AreOfAllKindsAndNoneIsAnEffectOfTheLibrary) {
  std::set<std::string> kinds, ids;
  for (const auto& mechanism : all_mechanisms()) kinds.insert(mechanism.kind), ids.insert(mechanism.id);
  EXPECT_EQ(kinds, (std::set<std::string>{"specimen", "polymer", "contacts", "loading", "instrument",
                                          "bookkeeping"}));
  EXPECT_EQ(ids.size(), all_mechanisms().size());
  EXPECT_THROW(find_mechanism("bridge_bending", "test"), BadInput);
}

TEST(Mechanism, WeakLayerSoftens) {
  EXPECT_LT(with("weak_layer", 0.02).stress_at(0.009), 0.95 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, CrackLowersThePeak) {
  EXPECT_LT(with("crack", 0.1).peak, 0.9 * without(0.1).peak);
}

TEST(Mechanism, BridgesThatYieldStayShort) {
  const Curve soft = with("bridge_yield", 0.04), elastic = without(0.04);
  EXPECT_GT(soft.residual, elastic.residual + 5e-4);
  EXPECT_LT(soft.stress_at(0.038), 0.95 * elastic.stress_at(0.038));
}

TEST(Mechanism, BridgesSoftInTensionSoftenTheSpecimen) {
  EXPECT_LT(with("tension_softness", 0.02).stress_at(0.009), 0.95 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, SoftContactsSoften) {
  EXPECT_LT(with("soft_contacts", 0.02).stress_at(0.009), 0.95 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, GritStiffens) {
  EXPECT_GT(with("grit", 0.02).stress_at(0.009), 1.05 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, APlatenThatCoversLessBearsLess) {
  EXPECT_LT(with("platen_overhang", 0.02).stress_at(0.009), 0.9 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, ASleeveStiffens) {
  EXPECT_GT(with("sleeve", 0.02).stress_at(0.009), 1.05 * without(0.02).stress_at(0.009));
}

TEST(Mechanism, ASaturatedCellReadsLess) {
  auto rows = rows_of({{0.0, 0.0}, {0.01, 1e6}});
  find_mechanism("cell_saturation", "test").rows(rows, machine(), 0.25);
  EXPECT_DOUBLE_EQ(rows[1].stress, 1e6 / 1.5);  // 2 N
}

TEST(Mechanism, BacklashIsTakenUpAtEachTurn) {
  auto rows = rows_of({{0.01, 0}, {0.02, 0}, {0.018, 0}, {0.01, 0}, {0.014, 0}, {0.03, 0}});
  find_mechanism("encoder_backlash", "test").rows(rows, machine(), 10.0);  // 0.005 of strain
  const std::vector<double> read = {0.01, 0.02, 0.02, 0.015, 0.015, 0.03};
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_DOUBLE_EQ(rows[k].strain, read[k]) << k;
}

TEST(Mechanism, ATaredPreloadIsZero) {
  auto rows = rows_of({{0.0, 0.0}, {0.01, 1e5}, {0.02, 3e5}, {0.03, 10e5}});
  find_mechanism("tared_preload", "test").rows(rows, machine(), 0.4);  // 2e5 Pa
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[0].stress, 0.0);
  EXPECT_DOUBLE_EQ(rows[1].stress, 7e5);
  EXPECT_DOUBLE_EQ(rows[1].strain, 0.01);
}

TEST(Mechanism, ASlowLoggerIsLate) {
  auto rows = rows_of({{0.01, 1.0}, {0.02, 2.0}, {0.03, 3.0}, {0.04, 3.0}});
  find_mechanism("slow_logger", "test").rows(rows, machine(), 0.02);
  EXPECT_DOUBLE_EQ(rows[0].stress, 0.5);
  EXPECT_DOUBLE_EQ(rows[2].stress, 2.5);
  EXPECT_DOUBLE_EQ(rows[3].stress, 3.0);
}

TEST(Mechanism, StrainOverTheWrongHeightIsSmaller) {
  auto rows = rows_of({{0.02, 1.0}});
  find_mechanism("wrong_height", "test").rows(rows, machine(), 0.25);
  EXPECT_DOUBLE_EQ(rows[0].strain, 0.015);
  EXPECT_DOUBLE_EQ(rows[0].stress, 1.0);
}

}  // namespace pendular::blind
