#include "dem_core/step/side_by_side_kernels.h"

#include <cstdint>

#include <hwy/cache_control.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem_core/step/side_by_side_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
//
#include "dem_core/step/pair_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t kParts = kRuns / kLanes;

Constants constants(const SideLaw& law, std::size_t lane, LawParts parts) {
  return {{load(law.k_glass + lane), load(law.kt_glass + lane), load(law.per_overlap + lane),
           load(law.friction + lane), load(law.damping + lane), load(law.dt + lane), load(law.half_dt + lane),
           load(law.half_damping_dt + lane)},
          parts,
          {load(law.per_force + lane), load(law.per_torque + lane), load(law.per_energy + lane)}};
}

HWY_INLINE Triple<Lanes> load(const double* x, const double* y, const double* z, std::size_t lane) {
  return {load(x + lane), load(y + lane), load(z + lane)};
}

template <bool bending>
HWY_INLINE void put_motion(const SideBead& i, const SideBead& j, std::size_t lane,
                           PairMotion<Lanes>& motion) {
  const Lanes radius_i = load(i.radius + lane), radius_j = load(j.radius + lane);
  const Triple<Lanes> spin_i = load(i.wx, i.wy, i.wz, lane), spin_j = load(j.wx, j.wy, j.wz, lane);
  motion.apart = load(i.x, i.y, i.z, lane) - load(j.x, j.y, j.z, lane);
  motion.velocity = load(i.vx, i.vy, i.vz, lane) - load(j.vx, j.vy, j.vz, lane);
  motion.rolling = mul_add(radius_i, spin_i, radius_j * spin_j);
  motion.spin = spin_i + spin_j;
  motion.radii = radius_i + radius_j;
  if (bending) motion.turning = spin_i - spin_j;
}

HWY_INLINE void take(WholeLanes less, std::int64_t* from) {
  const WholeLanes::Tag tag;
  hn::Store(hn::Sub(hn::Load(tag, from), less.v), tag, from);
}

HWY_INLINE void add_to_beads(const Shares& shares, std::size_t lane, SideSums& i, SideSums& j) {
  add_to(shares.force.x, i.fx + lane), add_to(shares.force.y, i.fy + lane),
      add_to(shares.force.z, i.fz + lane);
  add_to(shares.on_i.x, i.tx + lane), add_to(shares.on_i.y, i.ty + lane), add_to(shares.on_i.z, i.tz + lane);
  take(shares.force.x, j.fx + lane), take(shares.force.y, j.fy + lane), take(shares.force.z, j.fz + lane);
  take(shares.from_j.x, j.tx + lane), take(shares.from_j.y, j.ty + lane);
  take(shares.from_j.z, j.tz + lane);
}

/// Appends the runs whose lane is set; `first` is the run of the first lane.
void note_breaks(LaneMask breaking, std::size_t pair, std::size_t first, std::vector<SideBreak>& noted) {
  HWY_ALIGN double flags[kRuns];
  const Lanes::Tag tag;
  hn::Store(hn::IfThenElseZero(breaking.m, hn::Set(tag, 1.0)), tag, flags);
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    if (flags[lane] != 0.0) noted.push_back({pair, first + lane});
}

/// Whether the glass of a pair without a bond is apart in all runs, by more than rounding.
HWY_INLINE bool all_apart(const SideBead& i, const SideBead& j, const ContactBlock& contact) {
  bool apart = true;
  for (std::size_t lane = 0; lane < kRuns; lane += kLanes) {
    const Triple<Lanes> way = load(i.x, i.y, i.z, lane) - load(j.x, j.y, j.z, lane);
    const Lanes reach = load(i.radius + lane) + load(j.radius + lane) + load(contact.touch + lane);
    const Lanes squared = dot(way, way);
    apart &= !any(reach * reach >= same(1.0 - 1e-9, squared) * squared);
  }
  return apart;
}

/// Pairs from one whose second bead is asked for to the one that is advanced. First beads follow each other
/// in memory, as pairs do; second ones do not, and the processor does not foresee them.
constexpr std::size_t kAhead = 3;

template <typename T>
HWY_INLINE void fetch(const T& block) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof(T); at += kLine)
    hwy::Prefetch(reinterpret_cast<const char*>(&block) + at);
}

template <PairKind kind, bool bending>
void advance(SidePairs& pairs, SideBeads& beads, const SideLaw& law, LawParts parts, SideTotals& totals,
             std::vector<SideBreak>& breaking) {
  constexpr bool may_touch = kind != PairKind::apart;
  const WholeLanes::Tag tag;
  Constants given[kParts];
  Losses losses[kParts];
  for (std::size_t part = 0; part < kParts; ++part) {
    given[part] = constants(law, part * kLanes, parts);
    losses[part] = {{hn::Zero(tag)}, {hn::Zero(tag)}};
  }
  const SidePairs::Ends* const ends = pairs.ends.data();
  PairColumns* const columns = pairs.columns.data();
  ContactBlock* const contacts = pairs.contacts.data();
  BendBlock* const bends = pairs.bends.data();
  [[maybe_unused]] std::uint8_t* const were_apart = pairs.apart.data();
  SideBead* const motion = beads.motion.data();
  SideSums* const sums = beads.sums.data();
  const std::size_t size = pairs.ends.size();
  for (std::size_t p = 0; p < size; ++p) {
    if (kind == PairKind::loose) {
      if (were_apart[p] == kAllLanes && all_apart(motion[ends[p].i], motion[ends[p].j], contacts[p]))
        continue;
    }
    if (p + kAhead < size) fetch(motion[ends[p + kAhead].j]), fetch(sums[ends[p + kAhead].j]);
    for (std::size_t part = 0, lane = 0; part < kParts; ++part, lane += kLanes) {
      const SideBead &bead_i = motion[ends[p].i], &bead_j = motion[ends[p].j];
      PairMotion<Lanes> moving;
      put_motion<bending>(bead_i, bead_j, lane, moving);
      const PairApproach<Lanes> seen = approach(moving, given[part].law);
      BendBlock* const bend = bending ? bends + p : nullptr;
      PairAction<Lanes> action;
      LaneMask broken;
      if (!may_touch || glass_is_idle(seen.gap, contacts[p], lane, were_apart[p]))
        broken = advance_lanes<false, bending>(columns[p], nullptr, bend, lane, given[part], seen, moving,
                                               action, losses[part]);
      else
        broken = advance_lanes<true, bending>(columns[p], contacts + p, bend, lane, given[part], seen, moving,
                                              action, losses[part]);
      const Lanes difference = load(bead_i.radius + lane) - load(bead_j.radius + lane);
      Shares shares;
      put_shares<bending>(action, arms(moving.radii, difference, seen.gap), given[part].per, shares);
      add_to_beads(shares, lane, sums[ends[p].i], sums[ends[p].j]);
      if (any(broken)) note_breaks(broken, p, lane, breaking);
    }
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    add_to(losses[part].damped, totals.damped + part * kLanes);
    add_to(losses[part].slipped, totals.slipped + part * kLanes);
  }
}

template <bool bending>
void advance(SidePairs& pairs, PairKind kind, SideBeads& beads, const SideLaw& law, LawParts parts,
             SideTotals& totals, std::vector<SideBreak>& breaking) {
  const auto of = kind == PairKind::apart       ? advance<PairKind::apart, bending>
                  : kind == PairKind::touchable ? advance<PairKind::touchable, bending>
                                                : advance<PairKind::loose, bending>;
  of(pairs, beads, law, parts, totals, breaking);
}

void AdvanceSideBySide(SidePairs& pairs, PairKind kind, SideBeads& beads, const SideLaw& law, LawParts parts,
                       SideTotals& totals, std::vector<SideBreak>& breaking) {
  const auto of = parts.bending ? advance<true> : advance<false>;
  of(pairs, kind, beads, law, parts, totals, breaking);
}

/// Adds what one number of a bead's motion changes by in a step, and clears the sum that it follows from.
HWY_INLINE Lanes changed(Lanes per, std::int64_t* sum, const double* before) {
  const WholeLanes::Tag tag;
  const Lanes total = {from_48_bits(Lanes::Tag(), hn::Load(tag, sum))};
  hn::Store(hn::Zero(tag), tag, sum);
  return mul_add(per, total, load(before));
}

void MoveSideBySide(SideBeads& beads, std::size_t size, const SideLaw& law, SideTotals& totals) {
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t lane = 0; lane < kRuns; lane += kLanes) {
      SideBead& bead = beads.motion[k];
      SideSums& sums = beads.sums[k];
      const SideInertia& inertia = beads.inertia[k];
      const Lanes dt = load(law.dt + lane), per_mass = load(inertia.per_mass + lane),
                  per_inertia = load(inertia.per_inertia + lane);
      // Returns how far the bead has moved along the axis since its listing.
      const auto move = [&](double* place, double* velocity, std::int64_t* force, const float* listed) {
        const Lanes now = changed(per_mass, force + lane, velocity + lane);
        const Lanes there = mul_add(dt, now, load(place + lane));
        store(now, velocity + lane), store(there, place + lane);
        return there - load(listed + lane);
      };
      const Triple<Lanes> moved = {move(bead.x, bead.vx, sums.fx, inertia.listed_x),
                                   move(bead.y, bead.vy, sums.fy, inertia.listed_y),
                                   move(bead.z, bead.vz, sums.fz, inertia.listed_z)};
      const Lanes over_margin = load(inertia.per_margin_squared + lane) * dot(moved, moved);
      store(larger(load(totals.farthest + lane), over_margin), totals.farthest + lane);
      store(changed(per_inertia, sums.tx + lane, bead.wx + lane), bead.wx + lane);
      store(changed(per_inertia, sums.ty + lane, bead.wy + lane), bead.wy + lane);
      store(changed(per_inertia, sums.tz + lane, bead.wz + lane), bead.wz + lane);
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pendular::dem_core {
namespace {
HWY_EXPORT(AdvanceSideBySide);
HWY_EXPORT(MoveSideBySide);
}  // namespace

void advance_side_by_side(SidePairs& pairs, PairKind kind, SideBeads& beads, const SideLaw& law,
                          LawParts parts, SideTotals& totals, std::vector<SideBreak>& breaking) {
  HWY_DYNAMIC_DISPATCH(AdvanceSideBySide)(pairs, kind, beads, law, parts, totals, breaking);
}

void move_side_by_side(SideBeads& beads, std::size_t size, const SideLaw& law, SideTotals& totals) {
  HWY_DYNAMIC_DISPATCH(MoveSideBySide)(beads, size, law, totals);
}

}  // namespace pendular::dem_core
#endif
