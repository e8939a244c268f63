#include "diagnosis/kinds/simulated.h"

#include <gtest/gtest.h>

#include "effects/list.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;

TEST(Simulated, SeriesIsAPowerLawBetweenItsPoints) {
  const Observation series =
      observation(kinds::modulus_series(), "E", {{"E_p_pa", {1e5, 1e6, 1e7}}, {"modulus_pa", {1, 1, 1}}});
  const Columns columns = columns_of_series(series, {{1e7, 4e8}, {1e5, 4e6}});
  ASSERT_EQ(columns.at("modulus_pa").size(), 3u);
  EXPECT_NEAR(columns.at("modulus_pa")[0], 4e6, 1.0);
  EXPECT_NEAR(columns.at("modulus_pa")[1], 4e7, 10.0);
  EXPECT_NEAR(columns.at("modulus_pa")[2], 4e8, 100.0);
}

TEST(Simulated, AWrongVoxelSizeIsInAllThatAScanMeasures) {
  // Voxels taken 4 % too small: lengths are read 4 % too short, and strain, over a height read too short, too
  // large.
  SimulatedTest test;
  Frame frame;
  frame.strain = 0.02, frame.ids = {1}, frame.rest = {Vec3(0.0, 0.0, 1e-3)},
  frame.displacement = {Vec3(1e-6, 0.0, -2e-5)};
  test.frames = {frame};
  read_frames(effects::find_effect("voxel_scale", "test"), -0.04, test);
  EXPECT_NEAR(test.frames[0].strain, 0.02 / 0.96, 1e-12);
  EXPECT_NEAR(test.frames[0].rest[0].z(), 0.96e-3, 1e-12);
  EXPECT_NEAR((test.frames[0].displacement[0] - 0.96 * frame.displacement[0]).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace pendular::diagnosis
