#include "diagnosis/kinds/simulated.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace pendular::diagnosis
