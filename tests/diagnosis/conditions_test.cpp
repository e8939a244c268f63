#include "diagnosis/experiment/conditions.h"

#include <gtest/gtest.h>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;

TEST(Conditions, OneSpecimenIsSimulatedOnceAndAsFarAsAnyObservationGoes) {
  Experiment experiment;
  experiment.observations = {
      observation(kinds::compression(), "A",
                  {{"strain", {0.0, 0.02, 0.01, 0.04}}, {"stress_pa", {0, 2e5, 0, 5e5}}}),
      observation(kinds::lateral_strain(), "side",
                  {{"strain", {0.0, 0.06}}, {"lateral_strain", {0.0, 0.02}}}),
      observation(kinds::coordination(), "z", {{"z", {7.0}}, {"z_sigma", {0.1}}}),
      observation(kinds::bridge_gaps(), "gaps", {{"gap_um", {1, 2, 3, 4}}})};
  const auto conditions = conditions_of(experiment);
  ASSERT_EQ(conditions.size(), 1u);
  EXPECT_EQ(conditions[0].observations, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_NEAR(conditions[0].sample.compression.max_strain, 0.075, 1e-12);
  EXPECT_EQ(conditions[0].sample.compression.unload_at, std::vector{0.02});
}

TEST(Conditions, AnotherPolymerOrOtherBeadsAreAnotherSpecimen) {
  Experiment experiment;
  const auto curve =
      observation(kinds::compression(), "A", {{"strain", {0.0, 0.04}}, {"stress_pa", {0, 5e5}}});
  experiment.observations = {curve, curve, curve};
  experiment.observations[1].set = {{"bridges.youngs_modulus_pa", 6.4e5}};
  experiment.observations[2].beads = "beads.csv";
  const auto conditions = conditions_of(experiment);
  ASSERT_EQ(conditions.size(), 3u);
  EXPECT_EQ(conditions[1].sample.bridges.youngs_modulus, 6.4e5);
  EXPECT_EQ(conditions[2].beads, "beads.csv");
}

TEST(Conditions, ASeriesIsASpecimenPerRow) {
  Experiment experiment;
  experiment.observations = {
      observation(kinds::modulus_series(), "W",
                  {{"W", {0.01, 0.04}}, {"modulus_pa", {1e6, 3e6}}, {"modulus_sigma_pa", {1, 1}}}),
      observation(kinds::modulus_series(), "E",
                  {{"E_p_pa", {5e5}}, {"modulus_pa", {1e6}}, {"modulus_sigma_pa", {1}}})};
  const auto conditions = conditions_of(experiment);
  ASSERT_EQ(conditions.size(), 3u);
  // d ∝ √W.
  EXPECT_NEAR(conditions[1].sample.bridges.diameter / conditions[0].sample.bridges.diameter, 2.0, 1e-12);
  EXPECT_EQ(conditions[1].row, 1u);
  EXPECT_EQ(conditions[2].sample.bridges.youngs_modulus, 5e5);
}

}  // namespace
}  // namespace pendular::diagnosis
