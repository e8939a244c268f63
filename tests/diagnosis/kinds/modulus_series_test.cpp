#include <gtest/gtest.h>

#include <cmath>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

TEST(ModulusSeries, OfAPowerLaw) {
  Columns columns;
  for (double e : {1e5, 1e6, 1e7}) {
    columns["E_p_pa"].push_back(e);
    columns["modulus_pa"].push_back(20.0 * std::pow(e, 0.9));
    columns["modulus_sigma_pa"].push_back(0.02 * columns["modulus_pa"].back());
  }
  const Observation series = observation(kinds::modulus_series(), "E", columns);
  EXPECT_NEAR(value(series, "modulus_exponent"), 0.9, 1e-9);
  EXPECT_NEAR(value(series, "modulus_level"), 20.0 * std::pow(1e6, 0.9), 1e-3);
  // The mean of three logarithms of 2 % each; their slope over ±ln 10.
  const double expected = 0.02 / std::sqrt(3.0);
  EXPECT_NEAR(sigma(series, "modulus_level"), expected, 0.2 * expected);
  EXPECT_NEAR(sigma(series, "modulus_exponent"), 0.02 / (M_SQRT2 * M_LN10), 0.2 * 0.02 / (M_SQRT2 * M_LN10));
}

TEST(ModulusSeries, ContentBeyondTheFunicularTransitionStandsApart) {
  const Observation series = observation(
      kinds::modulus_series(), "W",
      {{"W", {0.01, 0.02, 0.035}}, {"modulus_pa", {2e6, 4e6, 5e6}}, {"modulus_sigma_pa", {1e5, 1e5, 1e5}}});
  EXPECT_NEAR(value(series, "modulus_exponent"), 1.0, 1e-9);
  EXPECT_NEAR(value(series, "modulus_beyond_funicular"), 5e6, 1.0);
}

}  // namespace
}  // namespace pendular::diagnosis
