#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(LoadingRate, IsTheSpeedOverTheStatedOne) {
  Sample sample = with("loading_rate", 3.0);
  Sample actual = actual_specimen(chains(), sample, 1).sample;
  EXPECT_DOUBLE_EQ(actual.compression.speed, 3e-4);
  EXPECT_EQ(actual.compression.control, "speed");
  sample.compression.speed_si = 0.02;
  actual = actual_specimen(chains(), sample, 1).sample;
  EXPECT_DOUBLE_EQ(*actual.compression.speed_si, 0.06);
  sample.effects["loading_rate"] = 1.0;
  sample.compression.control = "speed";
  EXPECT_EQ(sample_text(actual_specimen(chains(), sample, 1).sample), sample_text(sample));
}

TEST(LoadingRate, AFastTestIsStiffer) {
  const Sample rest = with("loading_rate", 30.0, 0.02);
  const auto slow = run(disordered(3, 4), without(rest)), fast = run(disordered(3, 4), rest);
  const auto bottom = [](const CompressResult& done) {
    double highest = 0.0;
    for (const auto& row : done.rows) highest = std::max(highest, row.stress_bottom);
    return highest;
  };
  EXPECT_GT(bottom(fast), 1.1 * bottom(slow));
}

}  // namespace
}  // namespace pendular::effects::test
