#include "dem_core/step/step_kernels.h"

#include <algorithm>
#include <string>

#include <fmt/ranges.h>
#include <hwy/cache_control.h>

#include "base/error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem_core/step/step_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
//
#include "dem_core/step/pair_lanes-inl.h"
#include "dem_core/step/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {
namespace {

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
  const Arms to_gap = arms(motion.radii, difference, seen.gap);
  store(to_gap.i, batch.arm_i + at), store(to_gap.j, batch.arm_j + at);
  if (bending) store(motion.spin, batch.spin, at), store(motion.turning, batch.turning, at);
}

/// Puts into the batch, from `at` on, how the pairs of a block move, from `lane` on.
template <bool bending>
HWY_INLINE void read_motion(const PairBlock& block, std::size_t lane, const BeadTable& beads,
                            const LawNumbers<Lanes>& law, Batch& batch, std::size_t at) {
  const double* HWY_RESTRICT bead = beads.motion.data();
  const double* HWY_RESTRICT spin = beads.spin.data();
  const std::uint32_t *i = block.i + lane, *j = block.j + lane;
#if HWY_MAX_BYTES == 64
  Columns apart, velocity;
  differences(bead, i, j, apart, velocity);
#else
  const Columns apart = differences(bead, i, j), velocity = differences(bead + 4, i, j);
#endif
  const Columns spin_i = columns_of(spin, i), spin_j = columns_of(spin, j);
  PairMotion<Lanes> motion;
  motion.apart = apart.xyz;
  motion.velocity = velocity.xyz;
  motion.rolling = mul_add(spin_i.fourth, spin_i.xyz, spin_j.fourth * spin_j.xyz);
  motion.spin = spin_i.xyz + spin_j.xyz;
  motion.radii = spin_i.fourth + spin_j.fourth;

  if (bending) motion.turning = spin_i.xyz - spin_j.xyz;
  put_motion<bending>(motion, apart.fourth, law, batch, at);
}

/// Adds what pairs do to the sums of their beads, one pair after the other.
template <bool bending>
HWY_INLINE void add_to_beads(const PairBlock& block, std::size_t lane, const Batch& batch, std::size_t at,
                             const LanesPerQuantum& per, std::int64_t* sums) {
  Shares shares;
  PairAction<Lanes> action;
  action.force = load(batch.force, at), action.couple = load(batch.couple, at);
  if (bending) action.moment = load(batch.moment, at);
  put_shares<bending>(action, {load(batch.arm_i + at), load(batch.arm_j + at)}, per, shares);
  const std::uint32_t *i = block.sum_i + lane, *j = block.sum_j + lane;
#if HWY_MAX_BYTES == 64
  const WholeLanes::Tag tag;
  Whole on_i[kLanes], from_j[kLanes];
  to_rows(shares.force, shares.on_i, on_i);
  to_rows(shares.force, shares.from_j, from_j);
  for (std::size_t p = 0; p < kLanes; ++p) {
    hn::Store(hn::Add(hn::Load(tag, sums + i[p]), on_i[p]), tag, sums + i[p]);
    hn::Store(hn::Sub(hn::Load(tag, sums + j[p]), from_j[p]), tag, sums + j[p]);
  }
#else
  const WholeRow row;
  Whole pushing[kLanes][kParts], turning_i[kLanes][kParts], turning_j[kLanes][kParts];
  to_rows(shares.force, pushing);
  to_rows(shares.on_i, turning_i);
  to_rows(shares.from_j, turning_j);
  for (std::size_t p = 0; p < kLanes; ++p)
    for (std::size_t part = 0, c = 0; part < kParts; ++part, c += kLanes) {
      std::int64_t *a = sums + i[p] + c, *b = sums + j[p] + c;
      hn::Store(hn::Add(hn::Load(row, a), pushing[p][part]), row, a);
      hn::Store(hn::Add(hn::Load(row, a + 4), turning_i[p][part]), row, a + 4);
      hn::Store(hn::Sub(hn::Load(row, b), pushing[p][part]), row, b);
      hn::Store(hn::Sub(hn::Load(row, b + 4), turning_j[p][part]), row, b + 4);
    }
#endif
}

/// Appends the pairs whose lane is set; `first` is the number of the first lane's pair.
void note_breaks(LaneMask breaking, std::size_t first, Chunk& chunk) {
  HWY_ALIGN double flags[kBlock];
  const Lanes::Tag tag;
  hn::Store(hn::IfThenElseZero(breaking.m, hn::Set(tag, 1.0)), tag, flags);
  for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane)
    if (flags[lane] != 0.0) chunk.breaking.push_back(static_cast<std::uint32_t>(first + lane));
}

/// Advances the pairs of a block from `lane` on, whose columns of the batch begin at `at`. Returns which
/// bonds break.
template <bool may_touch, bool bending>
HWY_INLINE LaneMask advance_batch(PairColumns& block, ContactBlock* contact, BendBlock* bend,
                                  std::size_t lane, const Constants& given, Batch& batch, std::size_t at,
                                  Losses& losses) {
  const PairApproach<Lanes> seen = {load(batch.n, at), load(batch.sliding, at), load(batch.gap + at),
                                    load(batch.closing + at), load(batch.twist + at)};
  PairMotion<Lanes> motion;
  if (bending) motion.spin = load(batch.spin, at), motion.turning = load(batch.turning, at);
  PairAction<Lanes> action;
  const LaneMask breaking =
      advance_lanes<may_touch, bending>(block, contact, bend, lane, given, seen, motion, action, losses);
  store(action.force, batch.force, at), store(action.couple, batch.couple, at);
  if (bending) store(action.moment, batch.moment, at);
  return breaking;
}

/// Whether no pair of a loose block does or remembers anything.
HWY_INLINE bool is_idle(const PairBlock& block, const ReachBlock& reach, std::uint8_t glass_apart,
                        const BeadTable& beads) {
  if (glass_apart != kAllLanes) return false;
  bool apart = true;
  for (std::size_t lane = 0; lane < kBlock; lane += kLanes) {
    const Triple<Lanes> way = differences(beads.motion.data(), block.i + lane, block.j + lane).xyz;
    apart &= !any(load(reach.squared + lane) >= dot(way, way));
  }
  return apart;
}

/// The blocks of one kind, from `first` to `last`.
template <PairKind kind, bool bending>
void advance(PairTable& pairs, BeadTable& beads, std::size_t first, std::size_t last, const Constants& given,
             Chunk& chunk, Losses& losses) {
  constexpr bool may_touch = kind != PairKind::apart;
  PairBlock* const blocks = pairs.blocks.data();
  ContactBlock* const contacts = pairs.contacts.data() + chunk.first_contact;
  std::uint8_t* const glass_apart = pairs.glass_apart.data() + chunk.first_contact;
  BendBlock* const bends = pairs.bends.data();
  Batch batch;
  for (std::size_t next = first; next < last;) {
    std::size_t taken[kBatch], count = 0;
    for (; next < last && count < kBatch; ++next)
      if (kind != PairKind::loose || !is_idle(blocks[next], pairs.reaches[chunk.first_reach + next - first],
                                              glass_apart[next - chunk.touchable], beads))
        taken[count++] = next;
    const auto for_lanes = [&](const auto& body) {
      for (std::size_t n = 0, at = 0; n < count; ++n)
        for (std::size_t lane = 0; lane < kBlock; lane += kLanes, at += kLanes) body(taken[n], lane, at);
    };
    for_lanes([&](std::size_t b, std::size_t lane, std::size_t at) {
      read_motion<bending>(blocks[b], lane, beads, given.law, batch, at);
    });
    for_lanes([&](std::size_t b, std::size_t lane, std::size_t at) {
      const std::size_t c = b - chunk.touchable;
      BendBlock* const bend = bending ? bends + b : nullptr;
      LaneMask breaking;
      if (!may_touch || glass_is_idle(load(batch.gap + at), contacts[c], lane, glass_apart[c]))
        breaking =
            advance_batch<false, bending>(blocks[b].columns, nullptr, bend, lane, given, batch, at, losses);
      else
        breaking = advance_batch<true, bending>(blocks[b].columns, contacts + c, bend, lane, given, batch, at,
                                                losses);
      if (any(breaking)) note_breaks(breaking, kBlock * b + lane, chunk);
    });
    for_lanes([&](std::size_t b, std::size_t lane, std::size_t at) {
      add_to_beads<bending>(blocks[b], lane, batch, at, given.per, beads.sums.data());
    });
  }
}

template <bool bending>
void advance(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law, LawParts parts,
             const PerQuantum& per) {
  // Another core may have moved the beads of other chunks.
  for (const std::uint32_t row : chunk.foreign)
    hwy::Prefetch(&beads.motion[row]), hwy::Prefetch(&beads.spin[row]);
  const WholeLanes::Tag tag;
  const Lanes zero = {hn::Zero(Lanes::Tag())};
  const Constants given = {{same(law.k_glass, zero), same(law.kt_glass, zero), same(law.per_overlap, zero),
                            same(law.friction, zero), same(law.damping, zero), same(law.dt, zero),
                            same(law.half_dt, zero), same(law.half_damping_dt, zero)},
                           parts,
                           {same(per.force, zero), same(per.torque, zero), same(per.energy, zero)}};
  Losses losses = {{hn::Zero(tag)}, {hn::Zero(tag)}};
  advance<PairKind::apart, bending>(pairs, beads, chunk.first_block, chunk.touchable, given, chunk, losses);
  advance<PairKind::touchable, bending>(pairs, beads, chunk.touchable, chunk.loose, given, chunk, losses);
  advance<PairKind::loose, bending>(pairs, beads, chunk.loose, chunk.last_block, given, chunk, losses);
  add(chunk.damped, hn::GetLane(hn::SumOfLanes(tag, losses.damped.v)));
  add(chunk.slipped, hn::GetLane(hn::SumOfLanes(tag, losses.slipped.v)));
}

void AdvancePairs(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
                  LawParts parts, const PerQuantum& per) {
  if (parts.bending)
    advance<true>(pairs, beads, chunk, law, parts, per);
  else
    advance<false>(pairs, beads, chunk, law, parts, per);
}

void collect(BeadTable& beads, const Chunk& chunk) {
  const WholeRow row;
  std::int64_t* HWY_RESTRICT sums = beads.sums.data();
  for (const auto& incoming : chunk.incoming)
    hwy::Prefetch(sums + kBeadRow * static_cast<std::size_t>(incoming.from));
  for (const auto& incoming : chunk.incoming)
    for (std::size_t c = 0; c < kBeadRow; c += hn::Lanes(row)) {
      std::int64_t* HWY_RESTRICT from = sums + kBeadRow * static_cast<std::size_t>(incoming.from) + c;
      std::int64_t* HWY_RESTRICT to = sums + kBeadRow * static_cast<std::size_t>(incoming.to) + c;
      hn::Store(hn::Add(hn::Load(row, to), hn::Load(row, from)), row, to);
      hn::Store(hn::Zero(row), row, from);
    }
}

/// Asks for a line of memory that is soon written: another core that has read it must give it up.
HWY_INLINE void prefetch_to_write(const void* line) {
#if HWY_ARCH_X86  // for the baseline of x86 the compiler asks for the line to be read
  asm volatile("prefetchw %0" : : "m"(*static_cast<const char*>(line)));
#else
  __builtin_prefetch(line, 1);
#endif
}

/// Asks for what moving a bead writes.
HWY_INLINE void prefetch_to_move(const BeadTable& beads, std::size_t k) {
  prefetch_to_write(&beads.motion[kBeadRow * k]);
  prefetch_to_write(&beads.spin[kBeadRow * k]);
  prefetch_to_write(&beads.sums[kBeadRow * k]);
}

void MoveBeads(BeadTable& beads, Chunk& chunk, double dt) {
  constexpr std::size_t kAhead = 16;
  collect(beads, chunk);
  const Row row;
  const WholeRow whole;
  const hn::Rebind<float, Row> listed_row;
  // The fourth numbers of a row stay as they are: the sums' are zero, and the position's is kept.
  HWY_ALIGN constexpr double moves[4] = {1.0, 1.0, 1.0, 0.0};
  const auto step = hn::Set(row, dt);
  auto farthest = hn::Zero(row);
  for (std::size_t k = chunk.first_bead; k < chunk.last_bead; ++k) {
    prefetch_to_move(beads, std::min(k + kAhead, chunk.last_bead - 1));
    double* HWY_RESTRICT bead = beads.motion.data() + kBeadRow * k;
    double* HWY_RESTRICT turning = beads.spin.data() + kBeadRow * k;
    std::int64_t* HWY_RESTRICT sums = beads.sums.data() + kBeadRow * k;
    const float* HWY_RESTRICT listed = beads.listed_rows.data() + 4 * k;
    auto squares = hn::Zero(row);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(row)) {
      const auto moving = hn::Mul(step, hn::Load(row, moves + c));
      const auto force = from_48_bits(row, hn::Load(whole, sums + c)),
                 torque = from_48_bits(row, hn::Load(whole, sums + 4 + c));
      const auto velocity = hn::MulAdd(hn::Set(row, bead[7]), force, hn::Load(row, bead + 4 + c));
      const auto spin = hn::MulAdd(hn::Set(row, turning[4]), torque, hn::Load(row, turning + c));
      const auto position = hn::MulAdd(moving, velocity, hn::Load(row, bead + c));
      hn::Store(position, row, bead + c);
      hn::Store(velocity, row, bead + 4 + c);
      hn::Store(spin, row, turning + c);
      hn::Store(hn::Zero(whole), whole, sums + c);
      hn::Store(hn::Zero(whole), whole, sums + 4 + c);
      const auto moved = hn::Sub(position, hn::PromoteTo(row, hn::Load(listed_row, listed + c)));
      squares = hn::MulAdd(moved, moved, squares);
    }
    farthest = hn::Max(farthest, hn::Mul(hn::Set(row, turning[5]), hn::SumOfLanes(row, squares)));
  }
  chunk.farthest = hn::GetLane(farthest);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pendular::dem_core {
namespace {
HWY_EXPORT(AdvancePairs);
HWY_EXPORT(MoveBeads);
}  // namespace

void advance_pairs(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
                   LawParts parts, const PerQuantum& per) {
  HWY_DYNAMIC_DISPATCH(AdvancePairs)(pairs, beads, chunk, law, parts, per);
}

void move_beads(BeadTable& beads, Chunk& chunk, double dt) {
  HWY_DYNAMIC_DISPATCH(MoveBeads)(beads, chunk, dt);
}

std::vector<std::string> instruction_sets() {
  hwy::SetSupportedTargetsForTest(0);
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.push_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(const std::string& name) {
  const auto names = instruction_sets();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      return;
    }
  bad_input("instruction set \"{}\": expected one of {}", name, fmt::join(names, ", "));
}

}  // namespace pendular::dem_core
#endif
