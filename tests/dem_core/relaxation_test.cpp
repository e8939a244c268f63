#include "dem_core/drive/relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "dem_core/compress.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::disordered;
using test::sample_a;
using test::ScratchFolder;

Sample relaxed(double max_strain, double increment) {
  Sample sample = sample_a();
  sample.compression.control = Control::relaxation;
  sample.compression.max_strain = max_strain;
  sample.compression.relax_increment = increment;
  sample.compression.frames = 0;
  return sample;
}

/// Stress of the row nearest to a strain.
double stress_at(const CompressResult& run, double strain) {
  const auto nearest = std::min_element(run.rows.begin(), run.rows.end(), [&](const auto& a, const auto& b) {
    return std::fabs(a.strain - strain) < std::fabs(b.strain - strain);
  });
  return nearest->stress;
}

TEST(Relaxation, ChainsOfBondsAreSpringsInSeries) {
  Sample sample = relaxed(5e-4, 1e-4);
  sample.compression.relax_to = 1e-7;
  ScratchFolder folder;
  const CompressResult run = compress(columns(3, 6, 0.03), sample, folder / "run", {});
  const double k_column = 1.0 / (2.0 / 57600.0 + 5.0 / 5760.0);
  const double height = (5 * 1.03 + 1) * 200.9e-6, section = 0.25 * M_PI * 4.25e-3 * 4.25e-3;
  ASSERT_EQ(run.rows.size(), 5u);
  for (const auto& row : run.rows) {
    EXPECT_NEAR(row.stress / row.strain, 9.0 * k_column * height / section, 1e-5 * row.stress / row.strain);
    EXPECT_NEAR(row.stress_bottom, row.stress, 1e-5 * row.stress);
    EXPECT_LE(row.unbalanced_force, 1e-7);
  }
}

TEST(Relaxation, IsWhatSlowerAndSlowerPlatensComeTo) {
  // Slip, touch and breaks on the way. The distance to the quasi-static stress falls with the speed.
  ScratchFolder folder;
  const Packing packing = disordered(4, 4);
  const CompressResult rest = compress(packing, relaxed(0.03, 2.5e-4), folder / "rest", {});
  const auto away = [&](double speed) {
    Sample sample = sample_a();
    sample.compression.max_strain = 0.03;
    sample.compression.speed = speed;
    sample.compression.frames = 0;
    const CompressResult run = compress(packing, sample, folder / "moving", {});
    double sum = 0.0;
    for (double strain : {0.01, 0.015, 0.02, 0.025})
      sum += std::fabs(stress_at(run, strain) / stress_at(rest, strain) - 1.0);
    return sum / 4.0;
  };
  const double fast = away(1e-3), slow = away(5e-5);
  EXPECT_GT(fast, 4.0 * slow);
  EXPECT_LT(slow, 0.01);
  EXPECT_LT(std::fabs(rest.result["work_balance"]["relative_error"].get<double>()), 1e-3);
  EXPECT_GT(rest.result["work_balance"]["slipped_j"].get<double>(), 0.0);
}

TEST(Relaxation, HaltedAndSetOffAgainNothingIsLost) {
  // Half of a swing, halted and given the same velocities back: what pairs remember must not notice.
  Simulation one = build_simulation(disordered(3, 3), sample_a());
  one.bottom.velocity = 0.0;
  Simulation other = one;
  Stepper straight(one), stopped(other);
  const auto field = [](const Vec3& at) { return Vec3(5.0 * at.z(), 0.0, 8.0 * at.x()); };
  straight.set_in_motion(0.0, field);
  stopped.set_in_motion(0.0, field);
  stopped.halt();
  stopped.set_in_motion(0.0, field);
  for (int k = 0; k < 50; ++k) straight.step(), stopped.step();
  straight.store(), stopped.store();
  for (std::size_t k = 0; k < one.beads.size(); ++k) {
    EXPECT_LT((one.beads.position[k] - other.beads.position[k]).norm(), 1e-14);
    EXPECT_LT((one.beads.velocity[k] - other.beads.velocity[k]).norm(),
              1e-9 * (1.0 + one.beads.velocity[k].norm()));
  }
  EXPECT_NEAR(one.work.halted, other.work.halted, 1e-9 * std::fabs(one.work.halted));
}

TEST(Relaxation, SameBytesForAnyThreadCount) {
  ScratchFolder folder;
  for (int threads : {1, 2}) {
    set_threads(threads);
    compress(disordered(4, 4), relaxed(0.02, 1e-3), folder / std::to_string(threads), {});
  }
  set_threads(0);
  for (const char* file : {"curve.csv", "events.csv", "checkpoint"})
    EXPECT_EQ(sha256_of(folder / "1" / file), sha256_of(folder / "2" / file)) << file;
}

TEST(Relaxation, LeavesUnloadingAndHoldsToThePlatensSpeed) {
  for (const char* keys : {"unload_at = [0.01]", "hold_at = [0.01]"})
    EXPECT_THROW(parse_sample(std::string("[compression]\ncontrol = \"relaxation\"\n") + keys, "sample"),
                 BadInput);
}

}  // namespace
}  // namespace pendular::dem_core
