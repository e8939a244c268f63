// Between tables and the law, as many pairs as a register holds: pairs of one specimen (step_kernels.cpp), or
// one pair of several runs (side_by_side_kernels.cpp).

#if defined(PENDULAR_DEM_CORE_PAIR_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_PAIR_LANES_INL_H
#undef PENDULAR_DEM_CORE_PAIR_LANES_INL_H
#else
#define PENDULAR_DEM_CORE_PAIR_LANES_INL_H
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

HWY_INLINE void add_to(WholeLanes more, std::int64_t* to) {
  const WholeLanes::Tag tag;
  hn::Store(hn::Add(hn::Load(tag, to), more.v), tag, to);
}

/// Of both beads, to mid-gap; `difference` is R_i − R_j.
struct Arms {
  Lanes i, j;
};
HWY_INLINE Arms arms(Lanes radii, Lanes difference, Lanes gap) {
  const Lanes half = same(0.5, difference), mean = mul_add(half, radii, half * gap);
  return {mul_add(half, difference, mean), neg_mul_add(half, difference, mean)};
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
HWY_INLINE void put_shares(const PairAction<Lanes>& action, const Arms& arms, const LanesPerQuantum& per,
                           Shares& to) {
  put_nearest_in_48_bits(per.force, action.force, to.force);
  if (bending) {
    put_nearest_in_48_bits(per.torque, neg_mul_add(arms.i, action.couple, action.moment), to.on_i);
    put_nearest_in_48_bits(per.torque, mul_add(arms.j, action.couple, action.moment), to.from_j);
  } else {
    put_nearest_in_48_bits(-per.torque * arms.i, action.couple, to.on_i);
    put_nearest_in_48_bits(per.torque * arms.j, action.couple, to.from_j);
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

/// Advances the pairs of a block from `lane` on. `motion` is read where the law has bending. Returns which
/// bonds break.
template <bool may_touch, bool bending>
HWY_INLINE LaneMask advance_lanes(PairColumns& block, ContactBlock* contact, BendBlock* bend,
                                  std::size_t lane, const Constants& given, const PairApproach<Lanes>& seen,
                                  const PairMotion<Lanes>& motion, PairAction<Lanes>& action,
                                  Losses& losses) {
  const Lanes zero = {hn::Zero(Lanes::Tag())};
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
  action = advance_pair<may_touch>(seen, motion, data, given.law, parts, memory);

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
  losses.damped = losses.damped + nearest(action.damped, given.per.energy);
  losses.slipped = losses.slipped + nearest(action.slipped, given.per.energy);
  return both(data.kn > zero, breaks(seen.gap, memory.bond_slip, data, parts.separate_limits));
}

/// Whether the glass of these lanes is apart and was in the last step, so that it neither does nor remembers
/// anything. Notes the first for the next step, in a bit of these lanes.
HWY_INLINE bool glass_is_idle(Lanes gap, const ContactBlock& contact, std::size_t lane,
                              std::uint8_t& was_apart) {
  const auto bit = static_cast<std::uint8_t>(1u << lane);
  const bool was = was_apart & bit, apart = !any(gap <= load(contact.touch + lane));
  was_apart = apart ? was_apart | bit : was_apart & ~bit;
  return was && apart;
}

/// The bits of all lanes of a block.
constexpr std::uint8_t bits_of_all_lanes() {
  std::uint8_t bits = 0;
  for (std::size_t lane = 0; lane < kBlock; lane += kLanes) bits |= static_cast<std::uint8_t>(1u << lane);
  return bits;
}
constexpr std::uint8_t kAllLanes = bits_of_all_lanes();

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
