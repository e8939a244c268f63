#include "diagnosis/kinds/curve_signature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace pendular::diagnosis {
namespace {

constexpr double kToe = 0.02, kModulus = 40e6, kUnloading = 55e6;

/// A parabola up to twice the toe, its tangent after that until 5 % of strain, then a parabola to a peak of
/// 1.5 MPa and down again.
double stress_of(double strain) {
  const double start = 2.0 * kToe, end = kToe + 0.03, peak = kToe + 0.045;
  if (strain < start) return 0.5 * kModulus * strain * strain / start;
  if (strain < end) return kModulus * (strain - kToe);
  const double rise = kModulus * (end - kToe), curvature = kModulus / (peak - end);
  return rise + kModulus * (strain - end) - 0.5 * curvature * (strain - end) * (strain - end);
}

Curve made(double last, double noise = 0.0, std::uint64_t seed = 1) {
  Curve curve;
  for (std::uint64_t k = 0; k <= 400; ++k) {
    const double strain = last * static_cast<double>(k) / 400.0;
    curve.strain.push_back(strain);
    curve.stress.push_back(stress_of(strain) + noise * random_normal(seed, k));
  }
  return curve;
}

/// With a loop at 5 % of strain: down along a straight line to zero stress, and back up to 0.1 MPa above it.
Curve with_loop() {
  Curve curve;
  for (double strain = 0.0; strain < 0.05; strain += 2e-4)
    curve.strain.push_back(strain), curve.stress.push_back(stress_of(strain));
  const double top = stress_of(0.05), width = top / kUnloading;
  for (int k = 0; k <= 60; ++k)
    curve.strain.push_back(0.05 - width * k / 60.0), curve.stress.push_back(top * (1.0 - k / 60.0));
  for (int k = 1; k <= 60; ++k) {
    const double share = k / 60.0, sag = 0.1e6 * 4.0 * share * (1.0 - share);
    curve.strain.push_back(0.05 - width * (1.0 - share));
    curve.stress.push_back(top * share + sag);
  }
  for (double strain = 0.0502; strain < 0.08; strain += 2e-4)
    curve.strain.push_back(strain), curve.stress.push_back(stress_of(strain));
  return curve;
}

const CurveFeature* named(const std::vector<CurveFeature>& features, const std::string& name) {
  const auto found =
      std::find_if(features.begin(), features.end(), [&](const auto& f) { return f.name == name; });
  return found == features.end() ? nullptr : &*found;
}

double value(const std::vector<CurveFeature>& features, const std::string& name) {
  const auto* found = named(features, name);
  return found ? found->value : std::nan("");
}

TEST(CurveSignature, OfAKnownCurve) {
  const auto features = curve_features(made(0.1), 0.1);
  // The linear part is grown while 1 % of the peak stress is kept, so that its ends are not quite straight.
  EXPECT_NEAR(value(features, "toe_strain"), kToe, 1e-3);
  EXPECT_NEAR(value(features, "linear_modulus"), kModulus, 0.04 * kModulus);
  EXPECT_NEAR(value(features, "toe_strain") + value(features, "peak_strain"), 0.065, 5e-4);
  EXPECT_NEAR(value(features, "peak_stress"), stress_of(0.065), 0.01 * stress_of(0.065));
  // Stress at the toe is a quarter of what the parabola has at twice of it.
  EXPECT_NEAR(value(features, "toe_roundness"), 0.25 * kToe / 0.01, 0.05 * kToe / 0.01);
  EXPECT_NEAR(value(features, "softening"), stress_of(0.085) / stress_of(0.065), 0.01);
  EXPECT_EQ(named(features, "unloading_modulus"), nullptr);
}

TEST(CurveSignature, LeavesOutWhatACurveDoesNotShow) {
  const auto features = curve_features(made(0.1), 0.045);
  EXPECT_NE(named(features, "linear_modulus"), nullptr);
  for (const char* name : {"peak_stress", "peak_strain", "softening", "linear_limit"})
    EXPECT_EQ(named(features, name), nullptr) << name;
}

TEST(CurveSignature, OfALoop) {
  const auto features = curve_features(with_loop(), 0.1);
  EXPECT_NEAR(value(features, "unloading_modulus"), kUnloading, 0.01 * kUnloading);
  const double top = stress_of(0.05), width = top / kUnloading;
  EXPECT_NEAR(value(features, "residual_strain"), 0.05 - 0.9 * width - value(features, "toe_strain"), 2e-3);
  // The way back lies above the way down by 0.1 MPa × 4 s(1 − s).
  const double expected = 0.1e6 * 2.0 / 3.0 * width / (0.5 * top * top / kUnloading);
  EXPECT_NEAR(value(features, "loop_area"), expected, 0.01 * expected);
}

TEST(CurveSignature, IsTheSameForAScaledCurve) {
  Curve curve = made(0.1);
  const auto before = curve_features(curve, 0.1);
  for (double& stress : curve.stress) stress *= 0.5;
  const auto after = curve_features(curve, 0.1);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const bool scales = before[k].name.ends_with("modulus") || before[k].name == "peak_stress";
    EXPECT_NEAR(after[k].value, (scales ? 0.5 : 1.0) * before[k].value, 1e-9 * std::fabs(before[k].value))
        << before[k].name;
  }
}

TEST(CurveSignature, NoiseIsFound) {
  EXPECT_NEAR(curve_noise(made(0.1, 0.01e6)), 0.01e6, 0.001e6);
}

}  // namespace
}  // namespace pendular::diagnosis
