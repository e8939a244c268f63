// Whether runs side by side in the lanes of a register pay: the same small packing with as many stiffnesses
// as a register has lanes, by the law of the DEM in double precision, against one run by the stepper. Fixed
// list of pairs, platens without friction: a prototype of the two loops that a step is made of.
//
//   cmake --build --preset bench --target lanes_bench && build-bench/bench/lanes_bench

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/parallel.h"
#include "dem_core/compress.h"
#include "dem_core/law/pair-inl.h"
#include "dem_core/step/step_kernels.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {

namespace dem_core {
using namespace HWY_NAMESPACE;  // of the instruction set that this file is compiled for
}

namespace {

namespace hn = hwy::HWY_NAMESPACE;

struct LanesBead {
  dem_core::Triple<dem_core::Lanes> position, velocity, spin, force, torque;
};
struct LanesPair {
  dem_core::PairMemory<dem_core::Lanes> memory;
  dem_core::Lanes rest, kn, kt, break_limit;
};

dem_core::Lanes all(double value) {
  return {hn::Set(dem_core::Lanes::Tag(), value)};
}
dem_core::Triple<dem_core::Lanes> all(const Vec3& v) {
  return {all(v.x()), all(v.y()), all(v.z())};
}

void advance(const dem_core::Pair& listed, LanesPair& pair, LanesBead& i, LanesBead& j, double radius_i,
             double radius_j, const dem_core::LawNumbers<dem_core::Lanes>& law, dem_core::Lanes& damped,
             dem_core::Lanes& slipped) {
  dem_core::PairMotion<dem_core::Lanes> motion;
  motion.apart = i.position - j.position;
  motion.velocity = i.velocity - j.velocity;
  motion.rolling = dem_core::mul_add(all(radius_i), i.spin, all(radius_j) * j.spin);
  motion.spin = i.spin + j.spin;
  motion.radii = all(radius_i + radius_j);
  const dem_core::PairApproach<dem_core::Lanes> seen = approach(motion, law);
  const dem_core::PairData<dem_core::Lanes> data = {
      pair.rest, all(listed.properties.touch), pair.kn, pair.kt, pair.break_limit, all(0.0), all(0.0)};
  const dem_core::PairAction<dem_core::Lanes> action =
      advance_pair<true>(seen, motion, data, law, {false, false, false}, pair.memory);
  const dem_core::LaneMask breaking =
      both(data.kn > all(0.0), dem_core::HWY_NAMESPACE::breaks(seen.gap, pair.memory.bond_slip, data));
  pair.kn = select(breaking, all(0.0), pair.kn), pair.kt = select(breaking, all(0.0), pair.kt);
  const dem_core::Lanes half_gap = all(0.5) * seen.gap;
  i.force = i.force + action.force, j.force = j.force - action.force;
  i.torque = dem_core::neg_mul_add(all(radius_i) + half_gap, action.couple, i.torque);
  j.torque = dem_core::neg_mul_add(all(radius_j) + half_gap, action.couple, j.torque);
  damped = damped + action.damped, slipped = slipped + action.slipped;
}

void move(LanesBead& bead, double radius, double mass, double inertia, double dt, double k_glass,
          double bottom, double top) {
  const dem_core::Lanes zero = all(0.0), z = bead.position.z;
  const dem_core::Lanes below = larger(all(bottom + radius) - z, zero),
                        above = larger(z - all(top - radius), zero);
  bead.force.z = dem_core::mul_add(all(k_glass), below - above, bead.force.z);
  bead.velocity = dem_core::mul_add(all(dt / mass), bead.force, bead.velocity);
  bead.spin = dem_core::mul_add(all(dt / inertia), bead.torque, bead.spin);
  bead.position = dem_core::mul_add(all(dt), bead.velocity, bead.position);
  bead.force = bead.torque = {zero, zero, zero};
}

/// Advances as many members of a bank as a register has lanes; returns their number.
std::size_t run_in_lanes(const dem_core::Simulation& s, int steps) {
  const auto& beads = s.beads;
  dem_core::AlignedVector<LanesBead> moving(beads.size());
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const dem_core::Triple<dem_core::Lanes> nowhere = all(Vec3(Vec3::Zero()));
    moving[k] = {all(beads.position[k]), all(beads.velocity[k]), all(beads.spin[k]), nowhere, nowhere};
  }
  const dem_core::Lanes weaker = {
      hn::MulAdd(hn::Iota(dem_core::Lanes::Tag(), 0.0), hn::Set(dem_core::Lanes::Tag(), -0.01), all(1.0).v)};
  dem_core::AlignedVector<LanesPair> pairs(s.pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto& [rest, touch, kn, kt, limit, k_bend, k_twist] = s.pairs[p].properties;
    pairs[p].rest = all(rest), pairs[p].break_limit = all(limit);
    pairs[p].kn = weaker * all(kn), pairs[p].kt = weaker * all(kt);
    const dem_core::PairHistory& history = s.pairs[p].history;
    pairs[p].memory.bond_slip = all(vec3(history.bond_slip));
    pairs[p].memory.contact_slip = all(vec3(history.contact_slip));
    pairs[p].memory.closing = all(history.closing);
  }
  const auto one = numbers(s.law, s.dt);
  const dem_core::LawNumbers<dem_core::Lanes> law = {
      all(one.k_glass), all(one.kt_glass), all(one.friction),       all(one.damping),
      all(one.dt),      all(one.half_dt),  all(one.half_damping_dt)};
  dem_core::Lanes damped = all(0.0), slipped = all(0.0);
  for (int step = 0; step < steps; ++step) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const dem_core::Pair& listed = s.pairs[p];
      advance(listed, pairs[p], moving[listed.i], moving[listed.j], beads.radius[listed.i],
              beads.radius[listed.j], law, damped, slipped);
    }
    for (std::size_t k = 0; k < moving.size(); ++k)
      move(moving[k], beads.radius[k], beads.mass[k], beads.inertia[k], s.dt, s.law.k_glass,
           s.bottom.z + step * s.dt * s.bottom.velocity, s.top.z);
  }
  return hn::Lanes(dem_core::Lanes::Tag());
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

dem_core::Simulation small_specimen() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.contact.bond_friction_limit = false;
  sample.specimen.diameter *= std::cbrt(0.17);
  sample.specimen.height *= std::cbrt(0.17);
  Packing packing = generate_packing(sample, 1);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  dem_core::Simulation simulation = dem_core::build_simulation(dem_core::realise(packing, sample, 1), sample);
  dem_core::Stepper stepper(simulation);
  while (simulation.strain() < 5e-3) stepper.step();
  stepper.store();
  return simulation;
}

}  // namespace
}  // namespace pendular

int main() {
  using namespace pendular;
  constexpr int kSteps = 300, kRepeats = 15;
  set_threads(1);
  const dem_core::Simulation loaded = small_specimen();
  const double beads = static_cast<double>(loaded.beads.size());
  std::vector<double> alone, in_lanes;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    dem_core::Simulation simulation = loaded;
    dem_core::Stepper stepper(simulation);
    double start = processor_seconds();
    for (int k = 0; k < kSteps; ++k) stepper.step();
    alone.push_back(beads * kSteps / (processor_seconds() - start));
    start = processor_seconds();
    const auto lanes = static_cast<double>(run_in_lanes(loaded, kSteps));
    in_lanes.push_back(lanes * beads * kSteps / (processor_seconds() - start));
  }
  std::sort(alone.begin(), alone.end());
  std::sort(in_lanes.begin(), in_lanes.end());
  fmt::print(
      "{} beads, {} pairs, medians: alone {:.1f} M particle-steps/s, in lanes {:.1f} M, ratio {:.2f}\n",
      beads, loaded.pairs.size(), 1e-6 * alone[kRepeats / 2], 1e-6 * in_lanes[kRepeats / 2],
      in_lanes[kRepeats / 2] / alone[kRepeats / 2]);
}
