#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(VoxelScale, LengthsAreSmallerThanMeasured) {
  const Sample sample = with("voxel_scale", 0.05);
  const Packing measured = disordered(4, 4);
  const auto specimen = actual_specimen(measured, sample, 1);
  EXPECT_NEAR(specimen.packing.beads[7].diameter * 1.05, measured.beads[7].diameter, 1e-15);
  EXPECT_LT((specimen.packing.beads[7].centre * 1.05 - measured.beads[7].centre).norm(), 1e-15);
  EXPECT_NEAR(specimen.sample.specimen.diameter * 1.05, sample.specimen.diameter, 1e-15);
  EXPECT_NEAR(specimen.packing.bridges[7].gap * 1.05, measured.bridges[7].gap, 1e-15);
}

TEST(VoxelScale, LeavesTheModulusThatStatedBondsGive) {
  // Chains between the same platens: stress over strain is k L/A, and L and A are both read wrongly.
  const Sample sample = with("voxel_scale", 0.05, 1e-3);
  const auto done = run(chains(), sample), believed = run(chains(), without(sample));
  EXPECT_NEAR(secant(done), secant(believed), 2e-3 * secant(believed));
  EXPECT_NEAR(done.rows.back().strain, believed.rows.back().strain / 1.05, 1e-9);
}

}  // namespace
}  // namespace pendular::effects::test
