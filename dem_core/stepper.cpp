#include "dem_core/stepper.h"

#include <algorithm>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "base/parallel.h"

namespace pendular {
namespace {

/// Ahead of an elastic wave the motion is denormal numbers, a hundred times slower to add than zeros.
void flush_denormals() {
#ifdef __SSE2__
  _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#endif
}

constexpr std::size_t kPairBlock = 1024, kBeadBlock = 512;

std::size_t blocks(std::size_t size, std::size_t block) {
  return (size + block - 1) / block;
}

}  // namespace

Stepper::Stepper(Simulation& simulation) : simulation_(simulation) {
  index_slots();
}

void Stepper::index_slots() {
  const auto& pairs = simulation_.pairs;
  const std::size_t beads = simulation_.beads.size();
  first_slot_.assign(beads + 1, 0);
  for (const auto& pair : pairs) ++first_slot_[pair.i + 1], ++first_slot_[pair.j + 1];
  for (std::size_t k = 0; k < beads; ++k) first_slot_[k + 1] += first_slot_[k];
  slots_.resize(2 * pairs.size());
  std::vector<int> next(first_slot_.begin(), first_slot_.end() - 1);
  for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
    slots_[next[pairs[p].i]++] = {p, 1.0};
    slots_[next[pairs[p].j]++] = {p, -1.0};
  }
  forces_.assign(pairs.size(), {});
  pair_sums_.assign(blocks(pairs.size(), kPairBlock), {});
  bead_sums_.assign(blocks(beads, kBeadBlock), {});
}

void Stepper::step() {
  move_beads();
  advance_pairs();
  gather_forces();
  collect_breaks();
  ++simulation_.steps;
}

void Stepper::move_beads() {
  auto& beads = simulation_.beads;
  const double dt = simulation_.dt;
  for_blocks(beads.size(), kBeadBlock, [&](std::size_t first, std::size_t last) {
    flush_denormals();
    double farthest = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      beads.position[k] += dt * beads.velocity[k];
      farthest = std::max(farthest, (beads.position[k] - simulation_.listed_at[k]).squaredNorm());
    }
    bead_sums_[first / kBeadBlock].farthest_squared = farthest;
  });
  simulation_.bottom.z += dt * simulation_.bottom.velocity;
  simulation_.top.z += dt * simulation_.top.velocity;
  double farthest = 0.0;
  for (const auto& sums : bead_sums_) farthest = std::max(farthest, sums.farthest_squared);
  if (4.0 * farthest > simulation_.skin * simulation_.skin) {
    list_pairs(simulation_);
    index_slots();
  }
}

void Stepper::advance_pairs() {
  auto& pairs = simulation_.pairs;
  const auto& beads = simulation_.beads;
  for_blocks(pairs.size(), kPairBlock, [&](std::size_t first, std::size_t last) {
    flush_denormals();
    BlockSums sums;
    for (std::size_t p = first; p < last; ++p) {
      Pair& pair = pairs[p];
      const int i = pair.i, j = pair.j;
      const PairMotion motion = {beads.position[i] - beads.position[j],
                                 beads.velocity[i] - beads.velocity[j],
                                 beads.spin[i],
                                 beads.spin[j],
                                 beads.radius[i],
                                 beads.radius[j]};
      const PairForce& force = forces_[p] =
          advance_pair(motion, pair.properties, simulation_.law, simulation_.dt, pair.history);
      sums.damped += force.damped;
      sums.slipped += force.slipped;
      sums.any_break |= force.breaks;
    }
    pair_sums_[first / kPairBlock] = sums;
  });
}

/// Bead against platen: the same law as between beads, without a bond; the platen does not turn. Returns the
/// force on the bead and adds to its torque.
Vec3 Stepper::platen_contact(std::size_t k, Platen& platen, Vec3& torque, double& normal, double& damped,
                             double& slipped) const {
  const auto& beads = simulation_.beads;
  const LawParameters& law = simulation_.law;
  const double gap = platen.normal_sign * (beads.position[k].z() - platen.z) - beads.radius[k];
  if (gap > 0.0) {
    platen.slip[k].setZero();
    return Vec3::Zero();
  }
  const Vec3 n(0.0, 0.0, platen.normal_sign);
  const double arm = beads.radius[k] + 0.5 * gap;
  const Vec3 velocity = beads.velocity[k] - Vec3(0.0, 0.0, platen.velocity);
  const Vec3 surface = velocity - arm * beads.spin[k].cross(n);
  const double closing = velocity.dot(n), glass = contact_force(gap, 0.0, law.k_glass);
  Vec3& slip = platen.slip[k];
  slip += (surface - surface.dot(n) * n) * simulation_.dt;
  slipped += limit_slip(slip, law.kt_glass, law.platen_friction * glass);
  const Vec3 tangential = -law.kt_glass * slip;
  damped += law.damping * closing * closing * simulation_.dt;
  normal = glass - law.damping * closing;
  torque -= arm * n.cross(tangential);
  return normal * n + tangential;
}

void Stepper::gather_forces() {
  auto& beads = simulation_.beads;
  const double dt = simulation_.dt;
  for_blocks(beads.size(), kBeadBlock, [&](std::size_t first, std::size_t last) {
    flush_denormals();
    BlockSums sums;
    for (std::size_t k = first; k < last; ++k) {
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
      for (int s = first_slot_[k]; s < first_slot_[k + 1]; ++s) {
        const PairForce& pair = forces_[slots_[s].pair];
        force += slots_[s].sign * pair.force;
        torque -= (beads.radius[k] + pair.half_gap) * pair.couple;
      }
      double bottom = 0.0, top = 0.0;
      force += platen_contact(k, simulation_.bottom, torque, bottom, sums.damped, sums.slipped);
      force += platen_contact(k, simulation_.top, torque, top, sums.damped, sums.slipped);
      sums.bottom += bottom;
      sums.top += top;
      beads.velocity[k] += dt / beads.mass[k] * force;
      beads.spin[k] += dt / beads.inertia[k] * torque;
    }
    bead_sums_[first / kBeadBlock] = sums;
  });
  simulation_.bottom.force = simulation_.top.force = 0.0;
  for (const auto& sums : bead_sums_) {
    simulation_.bottom.force += sums.bottom;
    simulation_.top.force += sums.top;
    simulation_.work.damped += sums.damped;
    simulation_.work.slipped += sums.slipped;
  }
  for (const auto& sums : pair_sums_) {
    simulation_.work.damped += sums.damped;
    simulation_.work.slipped += sums.slipped;
  }
  simulation_.work.platen += dt * (simulation_.bottom.force * simulation_.bottom.velocity -
                                   simulation_.top.force * simulation_.top.velocity);
}

/// Breaks are taken after the force pass, in order of pairs.
void Stepper::collect_breaks() {
  const auto& beads = simulation_.beads;
  for (std::size_t block = 0; block < pair_sums_.size(); ++block) {
    if (!pair_sums_[block].any_break) continue;
    const std::size_t last = std::min(simulation_.pairs.size(), (block + 1) * kPairBlock);
    for (std::size_t p = block * kPairBlock; p < last; ++p) {
      if (!forces_[p].breaks) continue;
      Pair& pair = simulation_.pairs[p];
      const Vec3 apart = beads.position[pair.i] - beads.position[pair.j];
      const double gap = apart.norm() - beads.radius[pair.i] - beads.radius[pair.j];
      BreakEvent event;
      event.strain = simulation_.strain();
      event.i = pair.i;
      event.j = pair.j;
      event.place = 0.5 * (beads.position[pair.i] + beads.position[pair.j]);
      event.stretch = gap - pair.properties.rest;
      event.shear = pair.history.bond_slip.norm();
      event.energy = break_bond(gap, simulation_.law, pair.properties, pair.history);
      simulation_.work.broken += event.energy;
      simulation_.bonds[pair.bond].broken = true;
      pair.bond = -1;
      simulation_.events.push_back(event);
    }
  }
}

}  // namespace pendular
