#include "dem_core/compress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "dem_core/checkpoint.h"
#include "dem_core/run_result.h"
#include "dem_core/step/stepper.h"
#include "micromechanics/stiffness.h"
#include "packing/polydata.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::disordered;
using test::sample_a;
using test::ScratchFolder;

TEST(Compress, ChainOfBondsHasTheStiffnessOfSpringsInSeries) {
  // Side by side 9 columns of 6 beads: per column two platen contacts (k_glass) and 5 bonds (kn) in series,
  // apart by gaps that never close at this strain. Quasi-static, so the stress is E·strain with E in closed
  // form.
  Sample sample = sample_a();
  sample.compression.max_strain = 5e-4;
  sample.compression.speed = 2e-6;
  sample.contact.damping_fraction = 0.5;
  const Packing packing = columns(3, 6, 0.03);
  ScratchFolder folder;
  const CompressResult result = compress(packing, sample, folder / "run", {});
  const double k_column = 1.0 / (2.0 / 57600.0 + 5.0 / 5760.0);
  const double height = (5 * 1.03 + 1) * 200.9e-6, section = 0.25 * M_PI * 4.25e-3 * 4.25e-3;
  const CurveRow& last = result.rows.back();
  EXPECT_NEAR(last.stress / last.strain, 9.0 * k_column * height / section, 0.02 * last.stress / last.strain);
  EXPECT_NEAR(last.stress_bottom, last.stress, 0.02 * last.stress);
}

TEST(Compress, TouchingColumnsOfHertzianBeadsPressAsStrainToThreeHalves) {
  // Per column two platen contacts and 5 between beads, alike but for the bonds that go on below touch:
  // F = K o^3/2 at platens, F = K p^3/2 + kn p between beads, 2 o + 5 p = travel.
  Sample sample = sample_a();
  sample.contact.glass = Glass::hertz;
  sample.contact.damping_fraction = 0.5;
  sample.compression.max_strain = 2e-3;
  sample.compression.speed = 2e-6;
  ScratchFolder folder;
  const CompressResult result = compress(columns(3, 6, 0.0), sample, folder / "run", {});
  const CurveRow& last = result.rows.back();
  const double k = 57600.0 / std::sqrt(0.005 * sample.beads.diameter), travel = last.strain * 6 * 200.9e-6;
  double low = 0.0, high = travel;  // overlap of a pair
  for (int step = 0; step < 60; ++step) {
    const double p = 0.5 * (low + high), force = k * std::pow(p, 1.5) + 5760.0 * p;
    (2.0 * std::pow(force / k, 2.0 / 3.0) + 5.0 * p < travel ? low : high) = p;
  }
  const double force = k * std::pow(low, 1.5) + 5760.0 * low, section = 0.25 * M_PI * 4.25e-3 * 4.25e-3;
  EXPECT_NEAR(last.stress, 9.0 * force / section, 0.02 * last.stress);
  EXPECT_LT(std::fabs(result.result["work_balance"]["relative_error"].get<double>()), 2e-3);
}

TEST(Compress, BridgesOfDifferentGapsAreDifferentSpringsInSeries) {
  // One column of five beads whose gaps are 2, 6, 10 and 4 µm, each bridge with its own kn by finite
  // elements.
  Sample sample = sample_a();
  sample.bridges.normal_stiffness = sample.bridges.tangential_stiffness = std::nullopt;
  sample.bridges.stiffness = StiffnessOf::per_bridge;
  sample.compression.max_strain = 5e-4;
  sample.compression.speed = 5e-7;  // slow: what damping adds to the stress is below 1 %
  sample.contact.damping_fraction = 0.5;
  Packing packing = columns(1, 5, 0.0);
  const double gaps[] = {2e-6, 6e-6, 10e-6, 4e-6};
  double shift = 0.0, compliance = 0.0;  // of the beads; of the bridges in series, m/N
  const double k_glass = 10.0 * micromechanics::bond_stiffness(sample).normal;
  for (int k = 0; k < 4; ++k) {
    shift += gaps[k];
    packing.beads[k + 1].centre.z() += shift;
    const micromechanics::BridgeBody body = {sample.bridges.diameter, gaps[k], 200.9e-6, 200.9e-6};
    compliance += 1.0 / micromechanics::bridge_stiffness(body, micromechanics::polymer_of(sample)).normal;
  }
  packing.bridges = candidate_bridges(packing.beads, 0.064 * 200.9e-6);
  ScratchFolder folder;
  const CompressResult result = compress(packing, sample, folder / "run", {});
  const double height = 5 * 200.9e-6 + shift, section = 0.25 * M_PI * 4.25e-3 * 4.25e-3;
  const CurveRow& last = result.rows.back();
  const double expected = height / section / (compliance + 2.0 / k_glass);
  EXPECT_NEAR(last.stress / last.strain, expected, 0.02 * expected);
}

TEST(Compress, WorkOfThePlatenIsFoundAgain) {
  Sample sample = sample_a();
  sample.compression.max_strain = 0.04;
  sample.compression.unload_at = {0.02};
  ScratchFolder folder;
  const CompressResult result = compress(disordered(4, 4), sample, folder / "run", {});
  EXPECT_LT(std::fabs(result.result["work_balance"]["relative_error"].get<double>()), 1e-3);
  EXPECT_GT(result.result["work_balance"]["slipped_j"].get<double>(), 0.0);
}

TEST(Compress, FreeSpecimenKeepsItsMomenta) {
  Simulation simulation = build_simulation(disordered(3, 3), sample_a());
  simulation.bottom.z -= 1.0, simulation.top.z += 1.0,
      simulation.bottom.velocity = 0.0;  // nothing outside touches it
  auto& beads = simulation.beads;
  double scale = 0.0, turning = 0.0;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    beads.velocity[k] = 30.0 * Vec3(random_normal(1, k), random_normal(2, k), random_normal(3, k));
    scale += beads.mass[k] * beads.velocity[k].norm();
    turning += beads.mass[k] * beads.position[k].cross(beads.velocity[k]).norm();
  }
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < beads.size(); ++k) sum += beads.mass[k] * beads.velocity[k];
    return sum;
  };
  // Positions half a step back, where the velocities are.
  const auto angular = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < beads.size(); ++k)
      sum += beads.mass[k] * beads.position[k].cross(beads.velocity[k]) + beads.inertia[k] * beads.spin[k];
    return sum;
  };
  const Vec3 p = momentum(), l = angular();
  Stepper stepper(simulation);
  for (int k = 0; k < 3000; ++k) stepper.step();
  stepper.store();
  EXPECT_GT(simulation.events.size(), 0u) << "the test should break bonds";
  EXPECT_LT((momentum() - p).norm(), 1e-12 * scale);
  EXPECT_LT((angular() - l).norm(), 1e-11 * turning);
}

TEST(Compress, SameBytesForAnyThreadCount) {
  Sample sample = sample_a();
  sample.compression.max_strain = 0.03;
  sample.compression.frames = 3;
  const Packing packing = disordered(4, 4);
  ScratchFolder folder;
  set_threads(1);
  compress(packing, sample, folder / "one", {});
  set_threads(2);
  compress(packing, sample, folder / "two", {});
  set_threads(0);
  for (const char* file : {"curve.csv", "events.csv", "frames/frame_0003.vtp", "checkpoint"})
    EXPECT_EQ(sha256_of(folder / "one" / file), sha256_of(folder / "two" / file)) << file;
}

TEST(Compress, CheckpointHoldsEverything) {
  Simulation simulation = build_simulation(disordered(3, 3), sample_a());
  Stepper stepper(simulation);
  for (int k = 0; k < 2000; ++k) stepper.step();
  stepper.store();
  RunState state;
  state.simulation = simulation;
  state.rows.resize(3);
  state.rows[1].stress = 5.0;
  state.frames_written = 2;
  ScratchFolder folder;
  write_checkpoint(folder / "checkpoint", state, "identity");
  RunState again = read_checkpoint(folder / "checkpoint", "identity");
  EXPECT_EQ(again.rows[1].stress, 5.0);
  EXPECT_EQ(again.frames_written, 2);
  Stepper resumed(again.simulation);
  for (int k = 0; k < 2000; ++k) stepper.step(), resumed.step();
  stepper.store(), resumed.store();
  for (std::size_t k = 0; k < simulation.beads.size(); ++k) {
    ASSERT_EQ(simulation.beads.position[k], again.simulation.beads.position[k]);
    ASSERT_EQ(simulation.beads.spin[k], again.simulation.beads.spin[k]);
  }
  EXPECT_EQ(simulation.work.slipped, again.simulation.work.slipped);
}

TEST(Compress, DamagedCheckpointIsRefused) {
  RunState state;
  state.simulation = build_simulation(disordered(2, 2), sample_a());
  ScratchFolder folder;
  write_checkpoint(folder / "checkpoint", state, "identity");
  EXPECT_THROW(read_checkpoint(folder / "checkpoint", "other work"), BadInput);
  const std::string good = read_text(folder / "checkpoint");
  for (std::size_t length :
       {std::size_t{0}, std::size_t{10}, std::size_t{60}, good.size() / 2, good.size() - 1}) {
    write_text(folder / "checkpoint", good.substr(0, length));
    EXPECT_THROW(read_checkpoint(folder / "checkpoint", "identity"), BadInput) << length;
  }
  std::string flipped = good;
  flipped[good.size() / 2] ^= 1;
  write_text(folder / "checkpoint", flipped);
  EXPECT_THROW(read_checkpoint(folder / "checkpoint", "identity"), BadInput);
}

TEST(Compress, OverlapsWithinMeasurementErrorDoNotPush) {
  const Simulation simulation = build_simulation(columns(3, 4, -0.005), sample_a());
  EXPECT_NEAR(energies(simulation).elastic, 0.0, 1e-25);
}

TEST(Compress, DivergenceIsSaid) {
  Sample sample = sample_a();
  sample.compression.max_strain = 0.05;
  const Packing packing = disordered(2, 2);
  sample.contact.time_step_fraction = 0.5;
  sample.contact.damping_fraction = 1.0;  // ζ dt/m beyond what the explicit step bears
  ScratchFolder folder;
  EXPECT_THROW(compress(packing, sample, folder / "run", {}), ComputationFailed);
  EXPECT_FALSE(fs::exists(folder / "run" / "curve.csv"));
}

TEST(Compress, NothingToCompress) {
  Packing lonely = columns(1, 1, 0.0);
  EXPECT_THROW(build_simulation(lonely, sample_a()), BadInput);
  Packing loose = columns(2, 2, 0.2);
  EXPECT_THROW(build_simulation(loose, sample_a()), BadInput) << "no bridge";
}

}  // namespace
}  // namespace pendular::dem_core
