#include "diagnosis/bank/contact_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/bank/feature_values.h"
#include "diagnosis/experiment/specimens.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "measured_beads.h"
#include "packing/bridges.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "scratch.h"

namespace pendular::diagnosis {
namespace {

using pendular::test::measured_beads;

/// A specimen that was measured, and the sample that is believed of it.
struct Measured {
  Measured(double unreported, double bias) {
    condition.sample = pendular::test::touching_sample();
    condition.beads = folder / "beads.csv";
    write_beads(condition.beads, measured_beads(unreported, bias), {});
  }

  /// The root mean square gap of pairs that truly touch, in the specimen that is simulated, m.
  double gaps_of_contacts(const std::map<std::string, double>& effects) const {
    Sample changed = condition.sample;
    changed.effects = effects;
    const auto source = MemberPackings(folder / "measured").of(condition, 1, changed);
    const Packing actual = effects::actual_specimen(read_packing(source.file), changed, 1).packing;
    double square = 0.0, count = 0.0;
    for (const auto& pair : candidate_bridges(pendular::test::touching_beads(), 0.2e-6))
      square += std::pow(gap(actual.beads[pair.i], actual.beads[pair.j]), 2), count += 1.0;
    return std::sqrt(square / count);
  }

  pendular::test::ScratchFolder folder;
  Condition condition;
};

const ContactFeature& named(const std::vector<ContactFeature>& features, const std::string& name) {
  return *std::find_if(features.begin(), features.end(),
                       [&](const ContactFeature& f) { return f.feature.name == name; });
}

TEST(ContactFeatures, AreWhatTheErrorsMakeOfTheTables) {
  for (const auto& [effect, theta, noise, bias] :
       {std::tuple("position_error", 2.0, 2e-6, 0.0), {"diameter_bias", -3.0, 0.0, -3e-6}}) {
    const auto peak = contact_peak({measured_beads(noise, bias)});
    ASSERT_TRUE(peak);
    const auto seen = contact_features(*peak);
    const auto expected = contact_features(expected_contacts(*peak, {{effect, theta}}));
    ASSERT_EQ(seen.size(), 2u);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      EXPECT_TRUE(is_of_beads(seen[k].feature));
      EXPECT_NEAR(seen[k].feature.value, expected[k].feature.value, 2.0 * seen[k].sigma);
    }
    const auto believed = contact_features(expected_contacts(*peak, {}));
    const char* telling = effect == std::string("diameter_bias") ? "contact_gap_um" : "contact_variance_um2";
    EXPECT_GT(std::fabs(named(seen, telling).feature.value - named(believed, telling).feature.value),
              4.0 * named(seen, telling).sigma);
    EXPECT_NEAR(effects::find_effect(effect, "test").shown_by_beads(*peak).value(), theta,
                0.15 * std::fabs(theta));
  }
}

TEST(ContactFeatures, ANarrowPeakLeavesNoRoomForUnreportedErrors) {
  // Variances add: 1 um along each axis would make the gaps of touching beads scatter by 1.5 um.
  const auto peak = contact_peak({measured_beads()});
  ASSERT_TRUE(peak);
  ASSERT_LT(peak->scatter, 0.5e-6);
  const auto seen = contact_features(*peak),
             with = contact_features(expected_contacts(*peak, {{"position_error", 1.0}}));
  const char* width = "contact_variance_um2";
  EXPECT_GT(named(with, width).feature.value - named(seen, width).feature.value,
            5.0 * named(seen, width).sigma);
}

TEST(ContactFeatures, ShowNothingOfOtherEffectsOrWithoutErrors) {
  const auto peak = contact_peak({measured_beads()});
  ASSERT_TRUE(peak);
  for (const auto& effect : effects::all_effects())
    EXPECT_FALSE(effect.shown_by_beads && effect.shown_by_beads(*peak)) << effect.id;
  auto unstated = measured_beads();
  for (auto& bead : unstated) bead.sigma_centre = bead.sigma_diameter = 0.0;
  EXPECT_EQ(contact_features(*contact_peak({unstated})).size(), 1u);  // its width can mean anything
}

TEST(Specimens, NoisyBeadsTouchAgainWhereTheNoiseIsKnown) {
  const Measured noisy(2e-6, 0.0);
  EXPECT_LT(noisy.gaps_of_contacts({{"position_error", 2.0}}), 0.5 * noisy.gaps_of_contacts({}));
}

TEST(Specimens, BeadsMeasuredTooSmallTouchAgainWhereTheBiasIsKnown) {
  const Measured small(0.0, -2e-6);
  EXPECT_LT(small.gaps_of_contacts({{"diameter_bias", -2.0}}), 0.3 * small.gaps_of_contacts({}));
}

}  // namespace
}  // namespace pendular::diagnosis
