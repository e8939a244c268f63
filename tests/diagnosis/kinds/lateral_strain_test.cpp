#include <gtest/gtest.h>

#include <cmath>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::value;

/// Expansion of a share of the platen's strain, of another beyond 3 %.
Observation barrelling(double early, double late, double sigma = 0.0) {
  Columns columns;
  for (int k = 0; k <= 300; ++k) {
    const double strain = 2e-4 * k;
    columns["strain"].push_back(strain);
    columns["lateral_strain"].push_back(early * std::min(strain, 0.03) + late * std::max(0.0, strain - 0.03));
    if (sigma > 0.0) columns["sigma"].push_back(sigma);
  }
  return observation(kinds::lateral_strain(), "side", columns);
}

TEST(LateralStrain, LandmarksAreTheSlopes) {
  const Observation side = barrelling(0.3, 0.8);
  EXPECT_NEAR(value(side, "lateral_ratio"), 0.3, 1e-9);
  EXPECT_NEAR(value(side, "late_lateral_ratio"), 0.8, 1e-9);
}

TEST(LateralStrain, ReadingsAreTheExpansionAtFixedStrains) {
  const Observation side = barrelling(0.3, 0.3);
  EXPECT_NEAR(value(side, "expansion_at_0.50_percent", Level::readings), 0.3 * 0.005, 1e-12);
  EXPECT_NEAR(value(side, "expansion_at_6.00_percent", Level::readings), 0.3 * 0.06, 1e-12);
}

TEST(LateralStrain, IsSimulatedByTheRowsOfItsTest) {
  SimulatedTest test;
  test.rows.resize(2);
  test.rows[1].strain = 0.01, test.rows[1].lateral_strain = 0.004;
  const Columns columns = kinds::lateral_strain().simulate(barrelling(0.3, 0.3), {Sample{}, &test});
  EXPECT_EQ(columns.at("lateral_strain"), (std::vector{0.0, 0.004}));
}

TEST(LateralStrain, NoiseHasTheStatedSize) {
  const Observation side = barrelling(0.0, 0.0, 2e-4);
  double square = 0.0;
  for (unsigned long seed = 0; seed < 20; ++seed) {
    const Columns noisy = side.kind->perturbed(side, seed);
    for (const double one : noisy.at("lateral_strain")) square += one * one / (20.0 * 301.0);
  }
  EXPECT_NEAR(std::sqrt(square), 2e-4, 0.1 * 2e-4);
}

TEST(LateralStrain, ErrorsOfTheSimulationAreAPositiveDefiniteCovariance) {
  const Observation side = barrelling(0.3, 0.8);
  for (const Level level : {Level::landmarks, Level::readings}) {
    const auto features = features_of(level, side, side.columns);
    test::expect_covariance(side.kind->model_error(features), features.size());
  }
}

}  // namespace
}  // namespace pendular::diagnosis
