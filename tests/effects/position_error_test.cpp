#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(PositionError, MovesCentresByTheNoiseStated) {
  const Packing measured = disordered(5, 5);
  const Packing actual = actual_specimen(measured, with("position_error", 2.0), 1).packing;
  double square = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < measured.beads.size(); ++k) {
    const Vec3 moved = actual.beads[k].centre - measured.beads[k].centre;
    square += moved.squaredNorm(), sum += moved.sum();
  }
  const double n = 3.0 * static_cast<double>(measured.beads.size());
  EXPECT_NEAR(std::sqrt(square / n), 2e-6, 2e-6 * 4.0 / std::sqrt(2.0 * n));
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 2e-6 / std::sqrt(n));
  for (const auto& bridge : actual.bridges)
    EXPECT_EQ(bridge.gap, gap(actual.beads[bridge.i], actual.beads[bridge.j]));
}

TEST(PositionError, OverlapsThatItMakesDoNotPush) {
  const Sample sample = with("position_error", 2.0);
  const dem_core::Simulation s = actual_simulation(actual_specimen(disordered(4, 4), sample, 1));
  double deepest = 0.0;
  for (const auto& pair : s.pairs) deepest = std::min(deepest, gap(s, pair));
  EXPECT_LT(deepest, -1e-6);
  EXPECT_LT(dem_core::energies(s).elastic, 1e-30);  // rounding; a bond at its limit holds 1e-6
}

TEST(PositionError, TheMeasurementReadsTheGivenBeads) {
  const Sample sample = with("position_error", 2.0);
  const Packing measured = disordered(4, 4);
  const Packing read = reading(actual_specimen(measured, sample, 1).packing, sample, 1);
  for (std::size_t k = 0; k < measured.beads.size(); ++k)
    EXPECT_LT((read.beads[k].centre - measured.beads[k].centre).norm(), 1e-17);
}

/// The effect makes errors known; those of an exact packing were not stated.
TEST(PositionError, DoesNotChangeHowDiametersAreUsed) {
  Sample sample = with("position_error", 2.0);
  sample.beads.diameters = Diameters::automatic;
  EXPECT_EQ(actual_specimen(disordered(4, 4), sample, 1).sample.beads.diameters, Diameters::drawn);
}

TEST(PositionError, LowersTheModulusOfDrawnDiameters) {
  Sample sample = with("position_error", 4.0);
  sample.beads.diameters = Diameters::drawn;
  EXPECT_LT(modulus(disordered(5, 5), sample), modulus(disordered(5, 5), without(sample)));
}

}  // namespace
}  // namespace pendular::effects::test
