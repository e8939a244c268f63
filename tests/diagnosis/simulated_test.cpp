#include "diagnosis/simulated.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pendular::diagnosis {
namespace {

TEST(Simulated, SeriesIsAPowerLawBetweenItsPoints) {
  Observation observation;
  observation.kind = Kind::modulus_series;
  observation.columns = {{"E_p_pa", {1e5, 1e6, 1e7}}, {"modulus_pa", {1, 1, 1}}};
  const Columns columns = columns_of_series(observation, {{1e7, 4e8}, {1e5, 4e6}});
  ASSERT_EQ(columns.at("modulus_pa").size(), 3u);
  EXPECT_NEAR(columns.at("modulus_pa")[0], 4e6, 1.0);
  EXPECT_NEAR(columns.at("modulus_pa")[1], 4e7, 10.0);
  EXPECT_NEAR(columns.at("modulus_pa")[2], 4e8, 100.0);
}

TEST(Simulated, DiametersHaveTheStatedSpreadUnlessTheEffectIsLarger) {
  Observation observation;
  observation.kind = Kind::bridge_diameters;
  observation.columns = {{"d_um", std::vector<double>(50, 70.0)}};
  Sample sample;
  sample.bridges.diameter = 70e-6, sample.bridges.diameter_sd = 7e-6;
  const auto spread = [&] {
    for (const auto& feature : features_of(observation, columns_of_bridges(observation, sample)))
      if (feature.name == "diameter_spread") return feature.value;
    return std::nan("");
  };
  EXPECT_NEAR(spread(), 0.1, 1e-9);
  sample.effects["bridge_diameter_spread"] = 14.0;
  EXPECT_NEAR(spread(), 0.2, 1e-9);
}

TEST(Simulated, TestedBridgesFollowTheStatedStiffness) {
  // The bridge that the sample states has the stiffness that it states; a thicker one is stiffer.
  Observation observation;
  observation.kind = Kind::bridge_stiffness;
  observation.columns = {{"d_um", {73.9, 100.0}}, {"D_um", {200.9, 200.9}}};
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0, sample.bridges.tangential_stiffness = 325.0;
  const Columns columns = columns_of_bridges(observation, sample);
  EXPECT_NEAR(columns.at("kn_n_per_m")[0], 5760.0, 6.0);  // the table interpolates
  EXPECT_NEAR(columns.at("kt_n_per_m")[0], 325.0, 0.4);
  EXPECT_GT(columns.at("kn_n_per_m")[1], 1.1 * 5760.0);
}

}  // namespace
}  // namespace pendular::diagnosis
