#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(LoadingRate, IsTheSpeedOverTheStatedOne) {
  Sample sample = with("loading_rate", 3.0);
  Sample actual = actual_specimen(chains(), sample, 1).sample;
  EXPECT_DOUBLE_EQ(actual.compression.speed, 3e-4);
  EXPECT_EQ(actual.compression.control, Control::speed);
  sample.compression.speed_si = 0.02;
  actual = actual_specimen(chains(), sample, 1).sample;
  EXPECT_DOUBLE_EQ(*actual.compression.speed_si, 0.06);
  sample.effects["loading_rate"] = 1.0;
  sample.compression.control = Control::speed;
  EXPECT_EQ(sample_text(actual_specimen(chains(), sample, 1).sample), sample_text(sample));
}

TEST(LoadingRate, BeadsHaveNineTimesTheEnergyAtThriceTheSpeed) {
  Sample sample = with("loading_rate", 3.0, 5e-3);
  sample.compression.control = Control::speed;
  const auto kinetic = [](const dem_core::CompressResult& done) {
    double sum = 0.0;
    for (const auto& row : done.rows) sum += row.kinetic;
    return sum / static_cast<double>(done.rows.size());
  };
  const Packing packing = columns(3, 6, kGap);
  EXPECT_NEAR(kinetic(run(packing, sample)) / kinetic(run(packing, without(sample))), 9.0, 3.0);
}

}  // namespace
}  // namespace pendular::effects::test
