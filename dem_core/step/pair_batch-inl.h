// The law between the beads of some pairs, as many at a time as a register holds, between what moves them
// and what adds up their forces: pairs of one specimen (step_kernels.cpp), or one pair of several
// (side_by_side_kernels.cpp).

#if defined(PENDULAR_DEM_CORE_PAIR_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_PAIR_BATCH_INL_H
#undef PENDULAR_DEM_CORE_PAIR_BATCH_INL_H
#else
#define PENDULAR_DEM_CORE_PAIR_BATCH_INL_H
#endif

#include <cstddef>

#include "dem_core/law/pair-inl.h"
#include "dem_core/step/step_tables.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {
namespace {

using Floats = hn::Rebind<float, Lanes::Tag>;

HWY_INLINE Lanes load(const double* from) {
  return {hn::Load(Lanes::Tag(), from)};
}
HWY_INLINE Lanes load(const float* from) {
  return {hn::PromoteTo(Lanes::Tag(), hn::Load(Floats(), from))};
}
HWY_INLINE void store(Lanes value, double* to) {
  hn::Store(value.v, Lanes::Tag(), to);
}
HWY_INLINE void store(Lanes value, float* to) {
  hn::Store(hn::DemoteTo(Floats(), value.v), Floats(), to);
}

/// Blocks taken at a time, in three loops that leave each other a number of each pair in the first-level
/// cache: how pairs move, what they do, and to which beads. Several pairs of such a short loop are under way
/// in a core at once, where one pair's whole way is a chain of operations that wait for each other.
constexpr std::size_t kBatch = 4;

struct Batch {
  using Column = double[kBatch * kBlock];
  struct Columns3 {
    HWY_ALIGN Column x, y, z;
  };
  Columns3 n, sliding;
  HWY_ALIGN Column gap, closing, twist;
  HWY_ALIGN Column arm_i, arm_j;  ///< half gap and radius
  Columns3 spin, turning;         ///< where the law has bending
  Columns3 force, couple, moment;
};

HWY_INLINE void store(const Triple<Lanes>& t, Batch::Columns3& to, std::size_t at) {
  const Lanes::Tag tag;
  hn::Store(t.x.v, tag, to.x + at), hn::Store(t.y.v, tag, to.y + at), hn::Store(t.z.v, tag, to.z + at);
}
HWY_INLINE Triple<Lanes> load(const Batch::Columns3& from, std::size_t at) {
  const Lanes::Tag tag;
  return {{hn::Load(tag, from.x + at)}, {hn::Load(tag, from.y + at)}, {hn::Load(tag, from.z + at)}};
}

/// Puts into the batch how pairs move; `difference` is R_i − R_j.
template <bool bending>
HWY_INLINE void put_motion(const PairMotion<Lanes>& motion, Lanes difference, const LawNumbers<Lanes>& law,
                           Batch& batch, std::size_t at) {
  const PairApproach<Lanes> seen = approach(motion, law);
  store(seen.n, batch.n, at), store(seen.sliding, batch.sliding, at);
  store(seen.gap, batch.gap + at), store(seen.closing, batch.closing + at),
      store(seen.twist, batch.twist + at);
  const Lanes half = same(0.5, difference);
  const Lanes mean = mul_add(half, motion.radii, half * seen.gap);
  store(mul_add(half, difference, mean), batch.arm_i + at);
  store(neg_mul_add(half, difference, mean), batch.arm_j + at);
  if (bending) store(motion.spin, batch.spin, at), store(motion.turning, batch.turning, at);
}

/// PerQuantum, of each lane.
struct LanesPerQuantum {
  Lanes force, torque, energy;
};

/// What pairs do to bead i, and what is taken from bead j.
struct Shares {
  Triple<WholeLanes> force, on_i, from_j;
};
template <bool bending>
HWY_INLINE void put_shares(const Batch& batch, std::size_t at, const LanesPerQuantum& per, Shares& to) {
  const Triple<Lanes> force = load(batch.force, at), couple = load(batch.couple, at);
  const Lanes arm_i = load(batch.arm_i + at), arm_j = load(batch.arm_j + at);
  put_nearest_in_48_bits(per.force, force, to.force);
  if (bending) {
    const Triple<Lanes> moment = load(batch.moment, at);
    put_nearest_in_48_bits(per.torque, neg_mul_add(arm_i, couple, moment), to.on_i);
    put_nearest_in_48_bits(per.torque, mul_add(arm_j, couple, moment), to.from_j);
  } else {
    put_nearest_in_48_bits(-per.torque * arm_i, couple, to.on_i);
    put_nearest_in_48_bits(per.torque * arm_j, couple, to.from_j);
  }
}

/// What all pairs of a chunk are given and what they sum up, in registers.
struct Constants {
  LawNumbers<Lanes> law;
  LawParts parts;
  LanesPerQuantum per;
};
struct Losses {
  WholeLanes damped, slipped;
};

/// Advances the pairs of a block from `lane` on, whose columns of the batch begin at `at`. Returns which
/// bonds break.
template <bool may_touch, bool bending>
HWY_INLINE LaneMask advance_lanes(PairColumns& block, ContactBlock* contact, BendBlock* bend, std::size_t lane,
                                  const Constants& given, Batch& batch, std::size_t at, Losses& losses) {
  const Lanes zero = {hn::Zero(Lanes::Tag())};
  const PairApproach<Lanes> seen = {load(batch.n, at), load(batch.sliding, at), load(batch.gap + at),
                                    load(batch.closing + at), load(batch.twist + at)};
  PairMotion<Lanes> motion;
  if (bending) motion.spin = load(batch.spin, at), motion.turning = load(batch.turning, at);

  PairData<Lanes> data;
  PairMemory<Lanes> memory;
  data.rest = load(block.rest + lane);
  data.kn = load(block.kn + lane), data.kt = load(block.kt + lane);
  data.break_limit = load(block.break_limit + lane);
  memory.closing = load(block.closing + lane);
  memory.bond_slip = {load(block.slip_x + lane), load(block.slip_y + lane), load(block.slip_z + lane)};
  data.touch = may_touch ? load(contact->touch + lane) : same(-1e300, zero);
  if (may_touch)
    memory.contact_slip = {load(contact->slip_x + lane), load(contact->slip_y + lane),
                           load(contact->slip_z + lane)};
  if (bending) {
    data.k_bend = load(bend->k_bend + lane), data.k_twist = load(bend->k_twist + lane);
    memory.turn = {load(bend->turn_x + lane), load(bend->turn_y + lane), load(bend->turn_z + lane)};
  }

  LawParts parts = given.parts;
  parts.bending = bending;
  const PairAction<Lanes> action = advance_pair<may_touch>(seen, motion, data, given.law, parts, memory);

  const Triple<Lanes>& slip = memory.bond_slip;
  store(slip.x, block.slip_x + lane), store(slip.y, block.slip_y + lane), store(slip.z, block.slip_z + lane);
  store(memory.closing, block.closing + lane);
  if (may_touch) {
    const Triple<Lanes>& sliding = memory.contact_slip;
    store(sliding.x, contact->slip_x + lane), store(sliding.y, contact->slip_y + lane);
    store(sliding.z, contact->slip_z + lane);
  }
  if (bending) {
    const Triple<Lanes>& turn = memory.turn;
    store(turn.x, bend->turn_x + lane), store(turn.y, bend->turn_y + lane),
        store(turn.z, bend->turn_z + lane);
  }
  store(action.force, batch.force, at), store(action.couple, batch.couple, at);
  if (bending) store(action.moment, batch.moment, at);
  losses.damped = losses.damped + nearest(action.damped, given.per.energy);
  losses.slipped = losses.slipped + nearest(action.slipped, given.per.energy);
  return both(data.kn > zero, breaks(seen.gap, memory.bond_slip, data));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
