#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(DiameterBias, BeadsAreSmallerThanMeasured) {
  const Sample sample = with("diameter_bias", 2.0);
  const Packing measured = disordered(4, 4);
  const auto specimen = actual_specimen(measured, sample, 1);
  EXPECT_NEAR(specimen.sample.beads.diameter, 198.9e-6, 1e-12);
  for (std::size_t k = 0; k < measured.beads.size(); ++k)
    EXPECT_NEAR(specimen.packing.beads[k].diameter, measured.beads[k].diameter - 2e-6, 1e-15);
  for (std::size_t k = 0; k < measured.bridges.size(); ++k)
    EXPECT_NEAR(specimen.packing.bridges[k].gap, measured.bridges[k].gap + 2e-6, 1e-15);
  const Packing read = reading(specimen.packing, sample, 1);
  for (std::size_t k = 0; k < measured.beads.size(); ++k)
    EXPECT_NEAR(read.beads[k].diameter, measured.beads[k].diameter, 1e-15);
}

TEST(DiameterBias, LowersTheModulus) {
  EXPECT_LT(modulus(disordered(4, 4), with("diameter_bias", 4.0)),
            0.99 * modulus(disordered(4, 4), without(with("diameter_bias", 4.0))));
}

TEST(DiameterBias, LowersTheNumberOfBridgesOfDrawnDiameters) {
  Sample sample = with("diameter_bias", 4.0);
  sample.beads.diameters = Diameters::drawn;
  EXPECT_LT(actual_specimen(disordered(5, 5), sample, 1).bodies.size(),
            actual_specimen(disordered(5, 5), without(sample), 1).bodies.size());
}

}  // namespace
}  // namespace pendular::effects::test
