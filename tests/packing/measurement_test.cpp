#include "packing/measurement.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "measured_beads.h"
#include "packing/bridges.h"
#include "packing/check.h"
#include "packing/touching.h"

namespace pendular {
namespace {

using test::measured_beads;
using test::touching_beads;

Sample sample_with(Diameters diameters) {
  Sample sample = test::touching_sample();
  sample.beads.diameters = diameters;
  return sample;
}

}  // namespace

TEST(Measurement, DiametersAreUsedAsMeasuredWhereErrorsAreStated) {
  EXPECT_EQ(Sample{}.beads.diameters, Diameters::automatic);
  const std::vector<Bead> stated = measured_beads(), exact = touching_beads();
  EXPECT_EQ(diameters_used(sample_with(Diameters::automatic), stated), Diameters::measured);
  EXPECT_EQ(diameters_used(sample_with(Diameters::automatic), exact), Diameters::drawn);
  for (const auto asked : {Diameters::measured, Diameters::drawn})
    for (const auto& beads : {stated, exact}) EXPECT_EQ(diameters_used(sample_with(asked), beads), asked);
}

TEST(Measurement, OfAnyBeadCountsAsStated) {
  std::vector<Bead> beads = touching_beads();
  EXPECT_FALSE(states_errors(beads));
  beads[3].sigma_diameter = 1e-7;
  EXPECT_TRUE(states_errors(beads));
}

TEST(Measurement, ContactsAreClosedUnlessDiametersAreDrawn) {
  const std::vector<Bead> measured = measured_beads();
  const Packing closed = packing_of(measured, sample_with(Diameters::automatic)),
                left = packing_of(measured, sample_with(Diameters::drawn));
  for (std::size_t k = 0; k < measured.size(); ++k) EXPECT_EQ(left.beads[k].centre, measured[k].centre);
  // The generator leaves some hundredths of a micrometre between beads that touch.
  const auto truly = static_cast<double>(candidate_bridges(touching_beads(), 0.2e-6).size());
  EXPECT_NEAR(static_cast<double>(touching_pairs(closed.beads)), truly, 0.15 * truly);
  EXPECT_EQ(closed.bridges.size(),
            candidate_bridges(closed.beads, 0.064 * sample_with(Diameters::automatic).beads.diameter).size());
}

TEST(Measurement, ClosingStaysWithinErrorsThatHoldAndNotWithinOthers) {
  const auto closing_at = [](double bias, double stated) {
    std::vector<Bead> measured = measured_beads(0.0, bias);
    for (auto& bead : measured) bead.sigma_centre = bead.sigma_diameter = stated;
    return closing(measured, closed_contacts(measured));
  };
  const Closing good = closing_at(0.0, test::kBeadSigma);
  EXPECT_GT(good.contacts, 200u);
  EXPECT_GT(good.rms_over_errors, 0.3);
  EXPECT_LT(good.rms_over_errors, 1.0);
  EXPECT_LT(good.centre_rms, test::kBeadSigma);
  EXPECT_LT(good.diameter_rms, test::kBeadSigma);
  EXPECT_GT(closing_at(2e-6, test::kBeadSigma).rms_over_errors, 1.5);
  EXPECT_GT(closing_at(0.0, 0.2 * test::kBeadSigma).rms_over_errors, 1.5);
}

TEST(Measurement, OverlapsThatItDoesNotExplainAreBadInput) {
  std::vector<Bead> beads(2);
  beads[0].id = 1, beads[1].id = 2;
  for (auto& bead : beads) bead.diameter = 200e-6;
  beads[1].centre = Vec3(0, 0, 191e-6);
  EXPECT_NO_THROW(check_overlaps(beads, "t"));
  beads[1].centre.z() = 189e-6;
  EXPECT_THROW(check_overlaps(beads, "t"), BadInput);
  for (auto& bead : beads) bead.sigma_centre = 2e-6;
  EXPECT_NO_THROW(check_overlaps(beads, "t"));
}

}  // namespace pendular
