#include "tests.h"

namespace pendular::effects::test {
namespace {

TEST(MachineCompliance, IsInSeriesWithTheSpecimen) {
  const Sample sample = with("machine_compliance", 20.0);
  const auto stiff = run(disordered(3, 4), without(sample)), soft = run(disordered(3, 4), sample);
  ASSERT_EQ(stiff.rows.size(), soft.rows.size());
  const double section = 0.25 * M_PI * std::pow(sample.specimen.diameter, 2);
  const double height = 1e-6 * stiff.result["specimen"]["height_um"].get<double>();
  for (std::size_t k = 0; k < stiff.rows.size(); ++k) {
    EXPECT_EQ(soft.rows[k].stress, stiff.rows[k].stress);
    // Travel of the machine: of the specimen, and 20 um for each newton.
    EXPECT_NEAR(soft.rows[k].strain * height,
                stiff.rows[k].strain * height + 20e-6 * stiff.rows[k].stress * section, 1e-15);
  }
  EXPECT_LT(secant(soft), secant(stiff));
}

}  // namespace
}  // namespace pendular::effects::test
