#include "diagnosis/kinds/features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::sigma;
using test::value;

/// A stiff curve with a toe and a soft end, to 8 % of strain. Half of the variance of a load cell's noise
/// lasts from row to row.
Observation curve(double noise, std::uint64_t seed, bool sigma_given) {
  Columns columns;
  double lasting = random_normal(seed + 1000, 0);
  for (std::uint64_t k = 0; k <= 300; ++k) {
    const double strain = 0.08 * static_cast<double>(k) / 300.0;
    const double stress = 1.5e6 * std::pow(std::sin(M_PI * std::min(strain, 0.07) / 0.14), 2) *
                          (strain < 0.07 ? 1.0 : 1.0 - 8.0 * (strain - 0.07));
    lasting = 0.7 * lasting + std::sqrt(0.51) * random_normal(seed + 1000, k + 1);
    columns["strain"].push_back(strain);
    columns["stress_pa"].push_back(stress + noise * M_SQRT1_2 * (lasting + random_normal(seed, k)));
    if (sigma_given) columns["stress_sigma_pa"].push_back(noise);
  }
  return observation(kinds::compression(), "curve", columns);
}

TEST(Features, SigmasOfACurveAreTheScatterOfItsRepeats) {
  const double noise = 0.01e6;
  const auto scatter_of = [&](Level level, const std::string& name) {
    double sum = 0.0, square = 0.0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const double v = std::log(value(curve(noise, 50 + seed, false), name, level));
      sum += v / 100.0, square += v * v / 100.0;
    }
    return std::sqrt(square - sum * sum);
  };
  for (const bool sigma_given : {true, false})
    for (const auto& [level, name] : {std::pair(Level::landmarks, "linear_modulus"),
                                      {Level::landmarks, "peak_stress"},
                                      {Level::readings, "stress_at_2.00_percent"},
                                      {Level::readings, "stress_at_6.00_percent"}}) {
      const double found = sigma(curve(noise, 1, sigma_given), name, level),
                   scatter = scatter_of(level, name);
      EXPECT_LT(found, 2.0 * scatter) << name;
      EXPECT_GT(found, 0.5 * scatter) << name;
    }
}

}  // namespace
}  // namespace pendular::diagnosis
