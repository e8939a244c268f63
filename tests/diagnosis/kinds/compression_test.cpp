#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;
using test::value;

constexpr double kModulus = 2e7, kUnloading = 5e7;
constexpr double kFloor = 0.004;  // strain below which the stress is too small to be told from none
constexpr double kLeast = 3e-3 * kModulus * 0.06 * 0.06 / 0.04;  // of the largest stress

/// Stress rises with the square of strain up to 4 %, where the platen turns until the stress is zero along a
/// straight line, and comes back along it; then on to 6 %.
Columns curve() {
  Columns columns;
  const auto add = [&](double strain, double stress) {
    columns["strain"].push_back(strain), columns["stress_pa"].push_back(stress);
  };
  const auto loading = [](double strain) { return kModulus * strain * strain / 0.04; };
  const double top = loading(0.04), width = top / kUnloading;
  for (int k = 0; k <= 160; ++k) add(2.5e-4 * k, loading(2.5e-4 * k));
  for (int k = 1; k <= 80; ++k) add(0.04 - width * k / 80.0, top * (1.0 - k / 80.0));
  for (int k = 1; k <= 80; ++k) add(0.04 - width * (1.0 - k / 80.0), top * k / 80.0);
  for (int k = 161; k <= 240; ++k) add(2.5e-4 * k, loading(2.5e-4 * k));
  return columns;
}

/// That whose reading this is (above nothing by kLeast²/reading).
double stress_of(const Feature& feature) {
  return feature.value - kLeast * kLeast / feature.value;
}

Observation measured() {
  return observation(kinds::compression(), "A", curve());
}

TEST(Compression, ReadingsAreTheStressAtFixedStrains) {
  const auto readings = features_of(Level::readings, measured(), curve());
  int read = 0;
  for (const auto& feature : readings) {
    if (!feature.name.starts_with("stress_at")) continue;
    const double strain = feature.strain_to, expected = kModulus * strain * strain / 0.04;
    // A line through rows within h of a parabola lies (h/strain)²/3 too high.
    const double high = std::pow(std::max(8e-4, 0.06 * strain) / strain, 2) / 3.0;
    if (strain < kFloor || strain > 0.056) continue;
    EXPECT_NEAR(stress_of(feature) / expected, 1.0 + high, 0.25 * high + 2e-4) << feature.name;
    EXPECT_TRUE(feature.logarithm);
    ++read;
  }
  EXPECT_EQ(read, 16);  // 0.45 to 5.5 %
}

TEST(Compression, ReadingsOfALoopAreItsSecantModulusAndItsHysteresis) {
  // The platen turns back and comes again along one straight line.
  for (const char* share : {"80", "60", "40", "30"}) {
    EXPECT_NEAR(value(measured(), fmt::format("unloading_modulus_1_at_{}_percent", share), Level::readings) /
                    kUnloading,
                1.0, 0.005);
    EXPECT_NEAR(value(measured(), fmt::format("hysteresis_1_at_{}_percent", share), Level::readings), 0.0,
                0.005);
  }
}

TEST(Compression, MisreadStrainsSoftenUnloadings) {
  // A machine in series: the strain that is read has c σ besides; 1/E grows by c, and a loop without area has
  // none.
  constexpr double kCompliance = 1e-8;
  Columns read = curve();
  for (std::size_t k = 0; k < read["strain"].size(); ++k)
    read["strain"][k] += kCompliance * read["stress_pa"][k];
  const Observation soft = observation(kinds::compression(), "A", read);
  EXPECT_NEAR(value(soft, "unloading_modulus_1_at_40_percent", Level::readings),
              1.0 / (1.0 / kUnloading + kCompliance), 0.005 * kUnloading);
  EXPECT_NEAR(value(soft, "hysteresis_1_at_40_percent", Level::readings), 0.0, 0.005);
}

TEST(Compression, AScaledCurveDiffersByItsFactorAlone) {
  Columns softer = curve();
  for (double& stress : softer["stress_pa"]) stress *= 0.7;
  const auto before = features_of(Level::readings, measured(), curve()),
             after = features_of(Level::readings, measured(), softer);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const std::string& name = before[k].name;
    if (name.starts_with("stress_at"))
      EXPECT_NEAR(stress_of(after[k]), 0.7 * stress_of(before[k]), 1e-9 * kModulus) << name;
    else
      EXPECT_NEAR(after[k].compared() - before[k].compared(),
                  name.starts_with("unloading_modulus") ? std::log(0.7) : 0.0, 1e-9)
          << name;
  }
}

TEST(Compression, NoiseAboutNothingStaysWhatItIs) {
  // Platens that meet at 1 %, and a load cell whose zero has drifted by its error.
  constexpr double kNoise = 5.0 * kLeast;
  Columns late = curve();
  for (std::size_t k = 0; k < late["strain"].size(); ++k) {
    if (late["strain"][k] < 0.01) late["stress_pa"][k] = -kNoise;
    late["stress_sigma_pa"].push_back(kNoise);
  }
  const Observation seen = observation(kinds::compression(), "A", late);
  const std::string name = "stress_at_0.45_percent";
  const double drifted = std::log(value(seen, name, Level::readings)), nothing = std::log(kNoise);
  EXPECT_NEAR(drifted, nothing - std::asinh(0.5), 1e-6);
  double sum = 0.0, squares = 0.0;
  constexpr int kRounds = 400;
  for (int seed = 1; seed <= kRounds; ++seed) {
    const Columns again = kinds::compression().perturbed(seen, static_cast<unsigned long>(seed));
    for (const auto& feature : features_of(Level::readings, seen, again))
      if (feature.name == name) sum += feature.compared(), squares += std::pow(feature.compared(), 2);
  }
  const double mean = sum / kRounds, sd = std::sqrt(squares / kRounds - mean * mean);
  // Of the mean of seven rows half of whose variance lasts with 0.7 from row to row: 0.575 of a row's.
  EXPECT_NEAR(sd, 0.575 / std::sqrt(1.0 + 4.0), 0.03);
}

TEST(Compression, NothingIsReadBeyondACurve) {
  Columns shorter = curve();
  for (auto& [name, column] : shorter) column.resize(120);  // to 3 %
  for (const auto& feature : features_of(Level::readings, measured(), shorter))
    EXPECT_LE(feature.strain_to, 0.03);
}

TEST(Compression, IsSimulatedByTheRowsOfItsTest) {
  SimulatedTest test;
  test.rows.resize(2);
  test.rows[1].strain = 0.01, test.rows[1].stress = 1e5;
  const Columns columns = kinds::compression().simulate(measured(), {Sample{}, &test});
  EXPECT_EQ(columns.at("strain"), (std::vector{0.0, 0.01}));
  EXPECT_EQ(columns.at("stress_pa"), (std::vector{0.0, 1e5}));
}

TEST(Compression, ItsTestGoesAsFarAndUnloadsWhereItDid) {
  Sample::Compression course;
  course.max_strain = 0.0;
  kinds::compression().course(measured(), course);
  EXPECT_DOUBLE_EQ(course.max_strain, 0.06);
  EXPECT_EQ(course.unload_at, std::vector{0.04});
}

TEST(Compression, NoiseHasTheStatedSizeAndHalfOfItLasts) {
  Columns columns;
  for (int k = 0; k < 4000; ++k)
    columns["strain"].push_back(1e-5 * k), columns["stress_pa"].push_back(0.0),
        columns["stress_sigma_pa"].push_back(3e3);
  const auto stress =
      kinds::compression().perturbed(observation(kinds::compression(), "A", columns), 5).at("stress_pa");
  double square = 0.0, next = 0.0;
  for (std::size_t k = 1; k < stress.size(); ++k)
    square += stress[k] * stress[k] / 4000.0, next += stress[k] * stress[k - 1] / 4000.0;
  EXPECT_NEAR(std::sqrt(square), 3e3, 0.1 * 3e3);
  EXPECT_NEAR(next / square, 0.5 * 0.7, 0.06);
}

TEST(Compression, ErrorsOfTheSimulationAreAPositiveDefiniteCovariance) {
  const auto readings = features_of(Level::readings, measured(), curve());
  const Eigen::MatrixXd error = kinds::compression().model_error(readings);
  test::expect_covariance(error, readings.size());
  // A shift of the strain at which platens meet the specimen is a larger share of a smaller strain.
  EXPECT_GT(error(0, 0), 4.0 * error(10, 10));
  // Beyond failure programs differ by ten times as much.
  std::vector<Feature> falling;
  for (const auto& [strain, stress] : {std::pair(0.01, 1e5), {0.02, 2e5}, {0.03, 1.5e5}, {0.04, 1.6e5}})
    falling.push_back(
        {"A", "stress_at_" + std::to_string(strain), Scale::aggregate, true, stress, strain, strain});
  const Eigen::MatrixXd failed = kinds::compression().model_error(falling);
  EXPECT_LT(std::sqrt(failed(0, 0)), 0.01);
  EXPECT_GT(std::sqrt(failed(2, 2)), 0.1);
  EXPECT_GT(std::sqrt(failed(3, 3)), 0.1);
  EXPECT_GT(std::sqrt(failed(1, 1)), 0.1);  // the fall begins after the largest of them
  const auto landmarks = features_of(Level::landmarks, measured(), curve());
  test::expect_covariance(kinds::compression().model_error(landmarks), landmarks.size());
}

}  // namespace
}  // namespace pendular::diagnosis
