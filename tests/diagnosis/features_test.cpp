#include "diagnosis/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

/// A stiff curve with a toe and a soft end, to 8 % of strain.
Observation curve(double noise, std::uint64_t seed, bool sigma_given) {
  Observation observation;
  observation.kind = Kind::compression;
  observation.name = "curve";
  for (std::uint64_t k = 0; k <= 300; ++k) {
    const double strain = 0.08 * static_cast<double>(k) / 300.0;
    const double stress = 1.5e6 * std::pow(std::sin(M_PI * std::min(strain, 0.07) / 0.14), 2) *
                          (strain < 0.07 ? 1.0 : 1.0 - 8.0 * (strain - 0.07));
    observation.columns["strain"].push_back(strain);
    observation.columns["stress_pa"].push_back(stress + noise * random_normal(seed, k));
    if (sigma_given) observation.columns["stress_sigma_pa"].push_back(noise);
  }
  return observation;
}

Observation sample(Kind kind, Columns columns) {
  Observation observation;
  observation.kind = kind;
  observation.name = fmt::format("rows");
  observation.columns = std::move(columns);
  return observation;
}

double value(const std::vector<Feature>& features, const std::string& name) {
  const auto found =
      std::find_if(features.begin(), features.end(), [&](const auto& f) { return f.name == name; });
  return found == features.end() ? std::nan("") : found->value;
}

double value(const Observation& observation, const std::string& name) {
  return value(features_of(observation, observation.columns), name);
}

TEST(Features, SigmasOfACurveAreTheScatterOfItsRepeats) {
  const double noise = 0.01e6;
  for (bool sigma_given : {true, false}) {
    const Observation one = curve(noise, 1, sigma_given);
    const auto features = features_of(one, one.columns);
    const auto sigmas = feature_sigmas(one, 100, 5);
    for (const char* name : {"linear_modulus", "peak_stress"}) {
      double sum = 0.0, square = 0.0;
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const double v = std::log(value(curve(noise, 50 + seed, false), name));
        sum += v / 100.0, square += v * v / 100.0;
      }
      const double scatter = std::sqrt(square - sum * sum);
      const auto at =
          std::find_if(features.begin(), features.end(), [&](const auto& f) { return f.name == name; });
      ASSERT_NE(at, features.end());
      const double sigma = sigmas[static_cast<std::size_t>(at - features.begin())];
      EXPECT_LT(sigma, 2.0 * scatter) << name;
      EXPECT_GT(sigma, 0.5 * scatter) << name;
    }
  }
}

TEST(Features, OfAPowerLawOfModulus) {
  Columns columns;
  for (double e : {1e5, 1e6, 1e7}) {
    columns["E_p_pa"].push_back(e);
    columns["modulus_pa"].push_back(20.0 * std::pow(e, 0.9));
    columns["modulus_sigma_pa"].push_back(0.02 * columns["modulus_pa"].back());
  }
  const Observation series = sample(Kind::modulus_series, columns);
  EXPECT_NEAR(value(series, "modulus_exponent"), 0.9, 1e-9);
  EXPECT_NEAR(value(series, "modulus_level"), 20.0 * std::pow(1e6, 0.9), 1e-3);
  // The mean of three logarithms of 2 % each.
  const auto sigmas = feature_sigmas(series, 400, 1);
  EXPECT_NEAR(sigmas[0], 0.02 / std::sqrt(3.0), 0.2 * 0.02 / std::sqrt(3.0));
}

TEST(Features, ContentBeyondTheFunicularTransitionStandsApart) {
  const Observation series = sample(
      Kind::modulus_series,
      {{"W", {0.01, 0.02, 0.035}}, {"modulus_pa", {2e6, 4e6, 5e6}}, {"modulus_sigma_pa", {1e5, 1e5, 1e5}}});
  EXPECT_NEAR(value(series, "modulus_exponent"), 1.0, 1e-9);
  EXPECT_NEAR(value(series, "modulus_beyond_funicular"), 5e6, 1.0);
}

TEST(Features, OfSamplesOfBridges) {
  Columns columns;
  for (std::uint64_t k = 0; k < 400; ++k) columns["d_um"].push_back(74.0 + 12.0 * random_normal(3, k));
  const Observation diameters = sample(Kind::bridge_diameters, columns);
  EXPECT_NEAR(value(diameters, "diameter_mean"), 74.0, 2.0);
  EXPECT_NEAR(value(diameters, "diameter_spread"), 12.0 / 74.0, 0.02);
  const auto sigmas = feature_sigmas(diameters, 200, 1);
  EXPECT_NEAR(sigmas[0], 12.0 / 74.0 / 20.0, 0.3 * 12.0 / 74.0 / 20.0);  // of the mean, as a logarithm
}

TEST(Features, OfDisplacementsOfAnAffineMotion) {
  // Bulk strain 0.8 of the platen's, lateral expansion 0.3 of it, a tilt of 0.1, and nothing else.
  Columns columns;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const double x = 4000 * random_uniform(1, k), y = 4000 * random_uniform(2, k),
                 z = 4000 * random_uniform(3, k);
    const double strain = 0.02;
    for (const auto& [name, v] : {std::pair("strain", strain),
                                  {"bead_id", double(k)},
                                  {"x_um", x},
                                  {"y_um", y},
                                  {"z_um", z},
                                  {"ux_um", 0.3 * strain * x},
                                  {"uy_um", 0.3 * strain * y},
                                  {"uz_um", -0.8 * strain * z + 0.1 * strain * x}})
      columns[name].push_back(v);
  }
  const Observation tracked = sample(Kind::displacements, columns);
  EXPECT_NEAR(value(tracked, "bulk_strain_share"), 0.8, 1e-9);
  EXPECT_NEAR(value(tracked, "radial_share"), 0.3, 1e-9);
  EXPECT_NEAR(value(tracked, "tilt_share"), 0.1, 1e-9);
  EXPECT_NEAR(value(tracked, "wandering"), 0.0, 1e-9);
}

TEST(Features, CountsScatterAsCountsDo) {
  const Observation breaks =
      sample(Kind::broken_bonds, {{"strain", {0.01, 0.02, 0.03, 0.04}}, {"count", {0, 100, 250, 400}}});
  EXPECT_EQ(value(breaks, "breaks_at_half"), 101.0);
  const auto sigmas = feature_sigmas(breaks, 400, 1);
  EXPECT_NEAR(sigmas[0], 0.1, 0.02);
  EXPECT_NEAR(sigmas[1], 0.05, 0.01);
}

}  // namespace
}  // namespace pendular::diagnosis
