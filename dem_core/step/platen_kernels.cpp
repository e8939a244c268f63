#include "dem_core/step/platen_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem_core/step/platen_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
//
#include "dem_core/law/platen-inl.h"
#include "dem_core/step/pair_lanes-inl.h"
#include "dem_core/step/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {
namespace {

/// In quanta.
struct PlatenShares {
  Triple<WholeLanes> force, torque;
  WholeLanes normal, damped, slipped;
};

HWY_INLINE void advance_bead(const PlatenNumbers<Lanes>& platen, LawParts parts, const LanesPerQuantum& per,
                             PlatenBead<Lanes>& bead, PlatenColumns& columns, std::size_t lane,
                             PlatenShares& to) {
  bead.relief = load(columns.relief + lane);
  PlatenMemory<Lanes> memory = {load(columns.slip_x + lane), load(columns.slip_y + lane),
                                load(columns.closing + lane)};
  const PlatenAction<Lanes> action = touch(platen, parts, bead, memory);
  store(memory.slip_x, columns.slip_x + lane), store(memory.slip_y, columns.slip_y + lane);
  store(memory.closing, columns.closing + lane);
  put_nearest_in_48_bits(per.force, action.force, to.force);
  to.torque.x = nearest_in_48_bits(per.torque, action.torque_x);
  to.torque.y = nearest_in_48_bits(per.torque, action.torque_y);
  to.torque.z = {hn::Zero(WholeLanes::Tag())};
  to.normal = nearest(per.force, action.normal);
  to.damped = nearest(per.energy, action.damped), to.slipped = nearest(per.energy, action.slipped);
}

HWY_INLINE void add_rows(const PlatenShares& shares, const std::uint32_t* at, std::int64_t* sums) {
#if HWY_MAX_BYTES == 64
  const WholeLanes::Tag tag;
  Whole rows[kLanes];
  to_rows(shares.force, shares.torque, rows);
  for (std::size_t p = 0; p < kLanes; ++p)
    hn::Store(hn::Add(hn::Load(tag, sums + at[p]), rows[p]), tag, sums + at[p]);
#else
  const WholeRow row;
  Whole pushing[kLanes][kParts], turning[kLanes][kParts];
  to_rows(shares.force, pushing);
  to_rows(shares.torque, turning);
  for (std::size_t p = 0; p < kLanes; ++p)
    for (std::size_t part = 0, c = 0; part < kParts; ++part, c += kLanes) {
      std::int64_t* to = sums + at[p] + c;
      hn::Store(hn::Add(hn::Load(row, to), pushing[p][part]), row, to);
      hn::Store(hn::Add(hn::Load(row, to + 4), turning[p][part]), row, to + 4);
    }
#endif
}

PlatenTotals PressBeads(AlignedVector<PlatenBlock>& near, BeadTable& beads,
                        const PlatenNumbers<double>& platen, LawParts parts, const PerQuantum& per) {
  const WholeLanes::Tag tag;
  const Lanes zero = {hn::Zero(Lanes::Tag())};
  const auto all = [&](double value) { return same(value, zero); };
  const PlatenNumbers<Lanes> given = {
      all(platen.z),        all(platen.velocity),       all(platen.sign),     all(platen.k_glass),
      all(platen.kt_glass), all(platen.per_overlap),    all(platen.friction), all(platen.damping),
      all(platen.dt),       all(platen.half_damping_dt)};
  const LanesPerQuantum lanes_per = {all(per.force), all(per.torque), all(per.energy)};
  WholeLanes force = {hn::Zero(tag)}, damped = force, slipped = force;
  for (PlatenBlock& block : near)
    for (std::size_t lane = 0; lane < kBlock; lane += kLanes) {
      const std::uint32_t* rows = block.row + lane;
      const Columns place = columns_of(beads.motion.data(), rows);
      PlatenBead<Lanes> bead;
      bead.z = place.xyz.z, bead.radius = place.fourth;
      bead.velocity = columns_of(beads.motion.data() + 4, rows).xyz;
      bead.spin = columns_of(beads.spin.data(), rows).xyz;
      PlatenShares shares;
      advance_bead(given, parts, lanes_per, bead, block.columns, lane, shares);
      add_rows(shares, rows, beads.sums.data());
      force = force + shares.normal, damped = damped + shares.damped, slipped = slipped + shares.slipped;
    }
  const auto sum = [&](WholeLanes lanes) { return hn::GetLane(hn::SumOfLanes(tag, lanes.v)); };
  return {sum(force), sum(damped), sum(slipped)};
}

void PressSideBySide(SidePlaten& platen, SideBeads& beads, const SideLaw& law, LawParts parts,
                     BlockOf<std::int64_t>& force, SideTotals& totals) {
  const PlatenNumbers<BlockOf<double>>& of = platen.numbers;
  for (std::size_t lane = 0; lane < kRuns; lane += kLanes) {
    const PlatenNumbers<Lanes> given = {load(of.z + lane),        load(of.velocity + lane),
                                        load(of.sign + lane),     load(of.k_glass + lane),
                                        load(of.kt_glass + lane), load(of.per_overlap + lane),
                                        load(of.friction + lane), load(of.damping + lane),
                                        load(of.dt + lane),       load(of.half_damping_dt + lane)};
    const LanesPerQuantum per = {load(law.per_force + lane), load(law.per_torque + lane),
                                 load(law.per_energy + lane)};
    for (const std::uint32_t row : platen.near) {
      const SideBead& one = beads.motion[row];
      PlatenBead<Lanes> bead;
      bead.z = load(one.z + lane), bead.radius = load(one.radius + lane);
      bead.velocity = {load(one.vx + lane), load(one.vy + lane), load(one.vz + lane)};
      bead.spin = {load(one.wx + lane), load(one.wy + lane), load(one.wz + lane)};
      PlatenShares shares;
      advance_bead(given, parts, per, bead, platen.beads[row], lane, shares);
      SideSums& on = beads.sums[row];
      add_to(shares.force.x, on.fx + lane), add_to(shares.force.y, on.fy + lane),
          add_to(shares.force.z, on.fz + lane);
      add_to(shares.torque.x, on.tx + lane), add_to(shares.torque.y, on.ty + lane);
      add_to(shares.normal, force + lane);
      add_to(shares.damped, totals.damped + lane), add_to(shares.slipped, totals.slipped + lane);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pendular::dem_core {
namespace {
HWY_EXPORT(PressBeads);
HWY_EXPORT(PressSideBySide);
}  // namespace

PlatenTotals press_beads(AlignedVector<PlatenBlock>& near, BeadTable& beads,
                         const PlatenNumbers<double>& platen, LawParts parts, const PerQuantum& per) {
  return HWY_DYNAMIC_DISPATCH(PressBeads)(near, beads, platen, parts, per);
}

void press_side_by_side(SidePlaten& platen, SideBeads& beads, const SideLaw& law, LawParts parts,
                        BlockOf<std::int64_t>& force, SideTotals& totals) {
  HWY_DYNAMIC_DISPATCH(PressSideBySide)(platen, beads, law, parts, force, totals);
}

}  // namespace pendular::dem_core
#endif
