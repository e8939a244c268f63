#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(BeadFriction, IsAddedToTheStatedOneAndNotBelowZero) {
  const auto friction = [](double theta) {
    return actual_simulation(actual_specimen(chains(), with("bead_friction", theta), 1)).law;
  };
  EXPECT_DOUBLE_EQ(friction(0.2).friction, 0.7);
  EXPECT_DOUBLE_EQ(friction(-1.0).friction, 0.0);
  EXPECT_EQ(friction(0.2).platen_friction, 0.5);
}

TEST(BeadFriction, LowFrictionIsSofter) {
  const Sample sample = with("bead_friction", -0.5, 0.05);
  EXPECT_LT(peak(run(disordered(4, 4), sample)), peak(run(disordered(4, 4), without(sample))));
}

}  // namespace
}  // namespace pendular::effects::test
