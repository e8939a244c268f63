#include "dem_core/drive/specimen_check.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::sample_a;

constexpr double kD = 200.9e-6;

Packing with_sigma(Packing packing, double sigma) {
  for (auto& bead : packing.beads) bead.sigma_centre = sigma;
  return packing;
}

/// Beads above `z` lifted, and the bridges that this leaves.
Packing lifted(Packing packing, double above, double by) {
  for (auto& bead : packing.beads)
    if (bead.centre.z() > above) bead.centre.z() += by;
  packing.bridges = candidate_bridges(packing.beads, 0.064 * kD);
  return packing;
}

struct Trial {
  const char* name;
  Packing packing;
  const char* wrong;  ///< part of what is said; nothing: it may be compressed
};

void PrintTo(const Trial& trial, std::ostream* out) {
  *out << trial.name;
}

class SpecimenCheck : public testing::TestWithParam<Trial> {};

TEST_P(SpecimenCheck, SaysWhatIsWrong) {
  const auto& [name, packing, wrong] = GetParam();
  const Simulation simulation = build_simulation(packing, sample_a());
  if (!wrong) {
    EXPECT_NO_THROW(check_specimen(packing, simulation, 0.1));
    return;
  }
  try {
    check_specimen(packing, simulation, 0.1);
    FAIL() << "was accepted";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, SpecimenCheck,
    testing::Values(Trial{"Whole", columns(2, 6, 0.03), nullptr},
                    Trial{"OverlapWithinMeasurement", columns(2, 6, -0.04), nullptr},
                    Trial{"DeepOverlap", columns(2, 6, -0.07), "beads 1 and"},
                    Trial{"DeepOverlapWithinFourSigma", with_sigma(columns(2, 6, -0.07), 0.02 * kD), nullptr},
                    Trial{"CutInTwo", lifted(columns(2, 6, 0.03), 2.5 * 1.03 * kD, 0.2 * kD),
                          "no network of bonds and touching beads joins the platens"},
                    Trial{"StrayBeadAbove", lifted(columns(1, 6, 0.03), 4.5 * 1.03 * kD, 3.0 * kD),
                          "(of 5 beads from z"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular::dem_core
