#include "dem_core/drive/platen_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem_core/compress.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::sample_a;
using test::ScratchFolder;

constexpr double kHeight = (5 * 1.03 + 1) * 200.9e-6, kSection = 0.25 * M_PI * 4.25e-3 * 4.25e-3;

/// Nine columns of six beads apart: two platen contacts and five bonds in series each.
Packing springs() {
  return columns(3, 6, 0.03);
}
double modulus_of_springs() {
  return 9.0 / (2.0 / 57600.0 + 5.0 / 5760.0) * kHeight / kSection;
}

Sample damped() {
  Sample sample = sample_a();
  sample.contact.damping_fraction = 0.5;
  sample.compression.frames = 1;
  return sample;
}

TEST(PlatenProgram, UnderStressControlStrainIsStressOverModulus) {
  const double modulus = modulus_of_springs();
  Sample sample = damped();
  sample.compression.max_strain = 0.01;
  sample.compression.control = Control::stress;
  sample.compression.max_stress = 4e-4 * modulus;
  sample.compression.stress_rate = modulus * 0.01 * platen_speed(sample) / kHeight;
  ScratchFolder folder;
  const auto rows = compress(springs(), sample, folder / "run", {}).rows;
  EXPECT_NEAR(rows.back().stress, *sample.compression.max_stress, 0.01 * *sample.compression.max_stress);
  for (const auto& row : rows) {
    if (row.stress < 0.3 * *sample.compression.max_stress) continue;
    EXPECT_NEAR(row.strain, row.stress / modulus, 0.02 * row.strain);
  }
}

TEST(PlatenProgram, StressFollowsItsRamp) {
  Simulation simulation = build_simulation(springs(), damped());
  Sample sample = damped();
  sample.compression.control = Control::stress;
  sample.compression.stress_rate = 1e8;
  const PlatenProgram program(simulation, sample);
  PlatenProgress progress;
  simulation.steps = 1000;
  const double ramp = 1e8 * 1000.0 * simulation.dt * kSection;
  struct {
    double force, sign;
  } cases[] = {{0.5 * ramp, 1.0}, {ramp, 0.0}, {1.5 * ramp, -1.0}};
  for (const auto& [force, sign] : cases) {
    simulation.bottom.force = force;
    program.drive(simulation, progress);
    EXPECT_GE(sign * simulation.bottom.velocity, 0.0);
    EXPECT_EQ(simulation.bottom.velocity == 0.0, sign == 0.0);
    EXPECT_LE(std::fabs(simulation.bottom.velocity), program.speed());
  }
}

TEST(PlatenProgram, HeldStressRelaxesToTheElasticOne) {
  Sample sample = damped();
  sample.compression.max_strain = 1.2e-3;
  sample.compression.hold_at = {1e-3};
  sample.compression.hold = 2e-3;
  sample.compression.rows_per_strain = 2e4;
  ScratchFolder folder;
  const auto rows = compress(springs(), sample, folder / "run", {}).rows;
  std::vector<CurveRow> held;
  for (const auto& row : rows)
    if (row.strain == rows[rows.size() / 2].strain) held.push_back(row);
  ASSERT_NEAR(static_cast<double>(held.size()), 2e-3 * 2e4, 2.0);
  EXPECT_NEAR(held.front().strain, 1e-3, 4e-6) << "within a step";
  const double elastic = modulus_of_springs() * held.front().strain;
  EXPECT_GT(held.front().stress, 1.02 * elastic) << "damping should add to the stress of a moving specimen";
  EXPECT_NEAR(held.back().stress, elastic, 0.002 * elastic);
  EXPECT_GT(rows.back().strain, 1.15e-3) << "loading should go on";
}

TEST(PlatenProgram, HoldTimeMayBeGivenInSeconds) {
  Sample sample = damped();
  sample.compression.max_strain = 1e-3;
  sample.compression.hold_at = {5e-4};
  sample.compression.hold_time = 2e-5;
  ScratchFolder folder;
  const auto held = compress(springs(), sample, folder / "held", {}).result;
  sample.compression.hold_at.clear();
  const auto straight = compress(springs(), sample, folder / "straight", {}).result;
  const double steps = held["steps"].get<double>() - straight["steps"].get<double>();
  EXPECT_NEAR(steps * held["time_step_s"].get<double>(), 2e-5, 2e-8);
}

TEST(PlatenProgram, RunEndsAtTheLargestStress) {
  Sample sample = damped();
  sample.compression.max_strain = 0.01;
  sample.compression.max_stress = 1e-3 * modulus_of_springs();
  ScratchFolder folder;
  const auto rows = compress(springs(), sample, folder / "run", {}).rows;
  EXPECT_GE(rows.back().stress, *sample.compression.max_stress);
  EXPECT_LT(rows[rows.size() - 2].stress, *sample.compression.max_stress);
}

TEST(PlatenProgram, KeysThatDoNotGoTogetherAreRefused) {
  for (const char* keys : {"control = \"stress\"", "stress_rate_pa_s = 1e6", "control = \"force\"",
                           "hold_at = [0.02, 0.01]", "hold_at = 0.02", "hold_s = -1", "max_stress_pa = 0",
                           "control = \"stress\"\nstress_rate_pa_s = 1e6\nunload_at = [0.01]",
                           "control = \"stress\"\nstress_rate_pa_s = 1e6\nhold_at = [0.01]"})
    EXPECT_THROW(parse_sample(std::string("[compression]\n") + keys, "s.toml"), BadInput) << keys;
  const Sample sample = parse_sample("[compression]\nhold_at = [0.01, 0.02]\nhold_s = 0.5\n", "s.toml");
  EXPECT_EQ(sample.compression.hold_at, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(sample.compression.hold_time, 0.5);
}

}  // namespace
}  // namespace pendular::dem_core
