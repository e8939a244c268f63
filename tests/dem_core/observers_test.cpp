#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "dem_core/compress.h"
#include "dem_core/observe/avalanches.h"
#include "dem_core/observe/frame.h"
#include "dem_core/observe/frame_observers.h"
#include "dem_core/observe/lateral_strain.h"
#include "dem_core/observe/quasi_static.h"
#include "dem_core/observe/stress_field.h"
#include "dem_core/step/stepper.h"
#include "packing/polydata.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::disordered;
using test::sample_a;
using test::ScratchFolder;

TEST(LateralStrain, ImposedExpansionIsFound) {
  Simulation simulation = build_simulation(disordered(4, 6), sample_a());
  auto& beads = simulation.beads;
  EXPECT_EQ(lateral_strain(simulation), 0.0);
  const Vec3 stretch(1.01, 1.01, 0.97), shift(3e-4, -2e-4, 1e-4);
  for (std::size_t k = 0; k < beads.size(); ++k)
    beads.position[k] = stretch.cwiseProduct(beads.start[k]) + shift;
  EXPECT_NEAR(lateral_strain(simulation), 0.01, 1e-12);
  // Rotation about the axis does not count.
  for (auto& x : beads.position) x = Eigen::AngleAxisd(1e-4, Vec3::UnitZ()) * x;
  EXPECT_NEAR(lateral_strain(simulation), 0.01, 1e-8);
}

TEST(LateralStrain, DebrisDoesNotCount) {
  Simulation simulation = build_simulation(disordered(4, 6), sample_a());
  auto& beads = simulation.beads;
  for (std::size_t k = 0; k < beads.size(); ++k)
    beads.position[k] = Vec3(1.02, 1.02, 1.0).cwiseProduct(beads.start[k]);
  const double middle = 0.5 * (simulation.bottom.z + simulation.top.z);
  std::size_t loose = beads.size();
  for (std::size_t k = 0; k < beads.size(); ++k)
    if (std::fabs(beads.start[k].z() - middle) < 1e-4 &&
        (loose == beads.size() || beads.start[k].x() < beads.start[loose].x()))
      loose = k;
  beads.position[loose].x() -= 1.0;
  EXPECT_GT(std::fabs(lateral_strain(simulation) - 0.02), 1.0) << "the bead should be one that counts";
  for (auto& bond : simulation.bonds)
    if (bond.i == static_cast<int>(loose) || bond.j == static_cast<int>(loose)) bond.broken = true;
  EXPECT_NEAR(lateral_strain(simulation), 0.02, 1e-12);
}

TEST(QuasiStatic, InertialNumberByHand) {
  EXPECT_NEAR(inertial_number(10.0, 2e-4, 2500.0, 1e6), 1e-4, 1e-18);
  EXPECT_NEAR(inertial_number(-10.0, 2e-4, 2500.0, 1e6), 1e-4, 1e-18);
  EXPECT_EQ(inertial_number(10.0, 2e-4, 2500.0, 0.0), std::numeric_limits<double>::infinity());
}

TEST(QuasiStatic, UnbalancedForceByHand) {
  // Three beads in a row, the gap between two of them opened by x: the bond pulls with kn x at both, nothing
  // else acts. Mean net force (F + F + 0)/3; mean of the two bonds' forces F/2.
  Simulation simulation = build_simulation(columns(1, 3, 0.03), sample_a());
  simulation.bottom.z -= 1e-3, simulation.top.z += 1e-3;
  EXPECT_EQ(unbalanced_force(simulation, forces(simulation)), 0.0);
  simulation.beads.position[0].z() -= 1e-6;
  const Forces now = forces(simulation);
  EXPECT_NEAR(now.net[0].z(), 5760.0 * 1e-6, 1e-12);
  EXPECT_NEAR(unbalanced_force(simulation, now), (2.0 / 3.0) / 0.5, 1e-9);
}

TEST(QuasiStatic, SlowRunIsAndFastRunIsNot) {
  Sample sample = sample_a();
  sample.contact.damping_fraction = 0.5;
  for (const auto& [speed, strain, holds] : {std::tuple(2e-6, 2e-3, true), {1e-3, 5e-3, false}}) {
    sample.compression.speed = speed;
    sample.compression.max_strain = strain;
    ScratchFolder folder;
    const auto done = compress(columns(3, 6, 0.03), sample, folder / "run", {});
    ASSERT_FALSE(done.result["quasi_static"].is_null()) << speed;
    EXPECT_EQ(done.result["quasi_static"]["holds"].get<bool>(), holds) << done.result["quasi_static"];
  }
}

BreakEvent broken(double strain, const Vec3& place, double energy) {
  BreakEvent event;
  event.strain = strain;
  event.place = place;
  event.energy = energy;
  return event;
}

TEST(Avalanches, PlantedOnesAreFound) {
  const AvalancheWindow window = {1e-5, 6e-4};
  const Vec3 here(1e-3, 2e-3, 3e-3), east(5e-4, 0, 0), far(5e-3, 0, 0);
  const std::vector<BreakEvent> events = {
      broken(0.010000, here, 1.0),
      broken(0.010004, here + far, 0.5),         // at the same time, elsewhere
      broken(0.010008, here + east, 2.0),        // near the first
      broken(0.010015, here + 2.0 * east, 3.0),  // near the one before only
      broken(0.020000, here, 0.25),              // at the first's place, later
  };
  const auto found = avalanches(events, window);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].breaks, 3);
  EXPECT_DOUBLE_EQ(found[0].energy, 6.0);
  EXPECT_EQ(found[0].first_strain, 0.010000);
  EXPECT_EQ(found[0].last_strain, 0.010015);
  EXPECT_LT((found[0].centre - (here + east)).norm(), 1e-15);
  EXPECT_NEAR(found[0].extent, 5e-4, 1e-15);
  EXPECT_EQ(found[1].breaks, 1);
  EXPECT_EQ(found[1].energy, 0.5);
  EXPECT_EQ(found[1].extent, 0.0);
  EXPECT_EQ(found[2].first_strain, 0.02);
  EXPECT_TRUE(avalanches({}, window).empty());
}

TEST(StressField, PressureAndDeviatorOfUniaxialStress) {
  Stress stress = Stress::Zero();
  stress(2, 2) = 3.0;
  EXPECT_DOUBLE_EQ(pressure(stress), 1.0);
  EXPECT_NEAR(deviatoric_stress(stress), 3.0, 1e-15);
}

/// A specimen compressed by 1 % and then left alone until it rests.
Simulation at_rest() {
  Sample sample = sample_a();
  sample.contact.damping_fraction = 0.3;
  Simulation simulation = build_simulation(disordered(4, 5), sample);
  Stepper stepper(simulation);
  while (simulation.strain() < 0.01) stepper.step();
  simulation.bottom.velocity = 0.0;
  for (int k = 0; k < 20000; ++k) stepper.step();
  stepper.store();
  return simulation;
}

TEST(StressField, ItsIntegralIsThePlatensForceTimesTheHeight) {
  // Of a body at rest between platens ∫ σ_zz dV = F H, whatever its shape.
  const Simulation simulation = at_rest();
  const Forces now = forces(simulation);
  ASSERT_LT(unbalanced_force(simulation, now), 0.01);
  const double reach = stress_field_reach(simulation), step = reach / 5.0;
  Vec3 low = simulation.beads.position.front(), high = low;
  for (const auto& x : simulation.beads.position) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const double margin = reach + 2e-4;
  std::vector<Vec3> grid;
  for (double x = low.x() - margin; x < high.x() + margin; x += step)
    for (double y = low.y() - margin; y < high.y() + margin; y += step)
      for (double z = low.z() - margin; z < high.z() + margin; z += step) grid.emplace_back(x, y, z);
  Stress integral = Stress::Zero();
  for (const auto& stress : stress_field(simulation, now, grid, reach))
    integral += step * step * step * stress;
  const double expected = simulation.top.force * (simulation.top.z - simulation.bottom.z);
  EXPECT_NEAR(integral(2, 2), expected, 0.01 * expected);
  // Across, only the platens' friction confines it.
  for (int axis : {0, 1}) {
    double friction = 0.0;
    for (const auto* platen : {&now.bottom, &now.top})
      for (const auto& [bead, force] : *platen)
        friction -= force[axis] * simulation.beads.position[bead][axis];
    EXPECT_NEAR(integral(axis, axis), friction, 0.005 * expected);
  }
}

TEST(ForceChains, ArePairsThatPushMoreThanTheMean) {
  const Simulation simulation = at_rest();
  ScratchFolder folder;
  std::vector<std::int64_t> ids(simulation.beads.size());
  write_frame(folder / "frame.vtp", simulation, ids, 0.0, {});
  const PolyTable frame = read_polydata(folder / "frame.vtp");
  const auto force = numbers(frame, false, "normal_force_n", folder / "frame.vtp");
  const auto chain = integers(frame, false, "force_chain", folder / "frame.vtp");
  double weakest_in = std::numeric_limits<double>::infinity(), strongest_out = 0.0, sum = 0.0, pushing = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k) {
    if (force[k] > 0.0) sum += force[k], pushing += 1.0;
    if (chain[k])
      weakest_in = std::min(weakest_in, force[k]);
    else
      strongest_out = std::max(strongest_out, force[k]);
  }
  EXPECT_GT(weakest_in, sum / pushing);
  EXPECT_LE(strongest_out, sum / pushing * (1.0 + 1e-12));
  EXPECT_EQ(numbers(frame, true, "pressure_pa", folder / "frame.vtp").size(), simulation.beads.size());
  for (double deviator : numbers(frame, true, "deviatoric_stress_pa", folder / "frame.vtp"))
    EXPECT_GE(deviator, 0.0);
}

/// Names of a frame's arrays.
std::set<std::string> arrays(const Simulation& simulation, const Sample::Observe& observe) {
  ScratchFolder folder;
  std::vector<std::int64_t> ids(simulation.beads.size());
  write_frame(folder / "frame.vtp", simulation, ids, 0.0, observe);
  const PolyTable frame = read_polydata(folder / "frame.vtp");
  std::set<std::string> names;
  for (const auto* data : {&frame.point_data, &frame.line_data})
    for (const auto& [name, array] : *data) names.insert(name);
  return names;
}

TEST(FrameObservers, AreSwitchedOffOneByOne) {
  const Simulation simulation = at_rest();
  const auto all = arrays(simulation, {});
  std::set<std::string> gone;
  for (const auto& observer : frame_observers()) {
    Sample::Observe observe;
    observe.*observer.switched_on = false;
    const auto left = arrays(simulation, observe);
    EXPECT_LT(left.size(), all.size());
    for (const auto& name : all) {
      if (left.contains(name)) continue;
      EXPECT_TRUE(gone.insert(name).second) << name << " has two switches";
    }
  }
  std::set<std::string> always = all;
  for (const auto& name : gone) always.erase(name);
  EXPECT_EQ(always, (std::set<std::string>{"bead_id", "diameter_um", "displacement_um", "state"}));
}

}  // namespace
}  // namespace pendular::dem_core
