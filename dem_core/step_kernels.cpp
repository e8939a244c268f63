#include "dem_core/step_kernels.h"

#include <algorithm>
#include <string>

#include <fmt/ranges.h>

#include "base/error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem_core/step_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
//
#include "dem_core/pair-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular {
namespace HWY_NAMESPACE {
namespace {

/// Rows of four numbers: x, y, z and one more. A register may hold a whole row or half of it.
using Row = hn::CappedTag<double, 4>;

/// Blocks taken at a time: the motion and the forces of their pairs stay in the first-level cache between
/// three loops.
constexpr std::size_t kBatch = 4;

/// The motion of a batch of pairs and what they do, a row of four per pair. Arrays are apart by an odd number
/// of cache lines, so that they do not compete for the same places in the cache.
struct Batch {
  static constexpr std::size_t kSize = 4 * kBatch * kBlock + 8;
  HWY_ALIGN double apart[kSize], velocity[kSize], rolling[kSize], spin[kSize], turning[kSize];
  HWY_ALIGN double force[kSize], torque_i[kSize], torque_j[kSize];
};

template <bool bending>
HWY_INLINE void read_motion(const PairBlock& block, const double* HWY_RESTRICT rows, std::size_t at,
                            Batch& batch) {
  const Row row;
  for (std::size_t p = 0; p < kBlock; ++p, at += 4) {
    const double* HWY_RESTRICT a = rows + block.i[p];
    const double* HWY_RESTRICT b = rows + block.j[p];
    const auto radius_a = hn::Set(row, a[3]), radius_b = hn::Set(row, b[3]);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(row)) {
      hn::Store(hn::Sub(hn::Load(row, a + c), hn::Load(row, b + c)), row, batch.apart + at + c);
      hn::Store(hn::Sub(hn::Load(row, a + 4 + c), hn::Load(row, b + 4 + c)), row, batch.velocity + at + c);
      const auto spin_a = hn::Load(row, a + 8 + c), spin_b = hn::Load(row, b + 8 + c);
      hn::Store(hn::MulAdd(radius_a, spin_a, hn::Mul(radius_b, spin_b)), row, batch.rolling + at + c);
      hn::Store(hn::Add(spin_a, spin_b), row, batch.spin + at + c);
      if (bending) hn::Store(hn::Sub(spin_a, spin_b), row, batch.turning + at + c);
    }
  }
}

/// Adds what the pairs of a block do to the sums of their beads.
HWY_INLINE void add_to_beads(const PairBlock& block, double* sums, std::size_t at, const Batch& batch) {
  const Row row;
  for (std::size_t p = 0; p < kBlock; ++p, at += 4) {
    double* a = sums + block.sum_i[p];
    double* b = sums + block.sum_j[p];
    for (std::size_t c = 0; c < 4; c += hn::Lanes(row)) {
      const auto force = hn::Load(row, batch.force + at + c);
      hn::Store(hn::Add(hn::Load(row, a + c), force), row, a + c);
      hn::Store(hn::Sub(hn::Load(row, b + c), force), row, b + c);
      hn::Store(hn::Add(hn::Load(row, a + 4 + c), hn::Load(row, batch.torque_i + at + c)), row, a + 4 + c);
      hn::Store(hn::Add(hn::Load(row, b + 4 + c), hn::Load(row, batch.torque_j + at + c)), row, b + 4 + c);
    }
  }
}

/// Four numbers per pair, from rows.
HWY_INLINE Triple<Lanes> columns(const double* HWY_RESTRICT rows, Lanes& fourth) {
  Triple<Lanes> t;
  hn::LoadInterleaved4(Lanes::Tag(), rows, t.x.v, t.y.v, t.z.v, fourth.v);
  return t;
}

HWY_INLINE void to_rows(const Triple<Lanes>& t, Lanes fourth, double* HWY_RESTRICT rows) {
  hn::StoreInterleaved4(t.x.v, t.y.v, t.z.v, fourth.v, Lanes::Tag(), rows);
}

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

/// Appends the pairs whose lane is set; `first` is the number of the first lane's pair.
void note_breaks(LaneMask breaking, std::size_t first, Chunk& chunk) {
  HWY_ALIGN double flags[kBlock];
  const Lanes::Tag tag;
  hn::Store(hn::IfThenElseZero(breaking.m, hn::Set(tag, 1.0)), tag, flags);
  for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane)
    if (flags[lane] != 0.0) chunk.breaking.push_back(static_cast<std::uint32_t>(first + lane));
}

/// What all pairs of a chunk are given and what they sum up, in registers.
struct Constants {
  LawNumbers<Lanes> law;
  LawParts parts;
};
struct Losses {
  Lanes damped, slipped;
};

/// Advances as many pairs of a block as a register holds, from `lane` on; their rows of the batch begin at
/// `at`.
template <bool may_touch, bool bending>
HWY_INLINE LaneMask advance_lanes(PairBlock& block, ContactBlock* contact, BendBlock* bend, std::size_t lane,
                                  std::size_t at, const Constants& given, Batch& batch, Losses& losses) {
  const Lanes zero = {hn::Zero(Lanes::Tag())}, half = same(0.5, zero);
  PairMotion<Lanes> motion;
  Lanes unused, difference;
  motion.apart = columns(batch.apart + at, difference);
  motion.velocity = columns(batch.velocity + at, unused);
  motion.rolling = columns(batch.rolling + at, unused);
  motion.spin = columns(batch.spin + at, motion.radii);
  if (bending) motion.turning = columns(batch.turning + at, unused);

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
  const PairAction<Lanes> action = advance_pair<may_touch>(motion, data, given.law, parts, memory);

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
  // Minus the arms: half gap and radius.
  const Lanes mean = neg_mul_add(half, motion.radii, -action.half_gap);
  const Lanes arm_i = neg_mul_add(half, difference, mean), arm_j = mul_add(half, difference, mean);
  Triple<Lanes> torque_i = arm_i * action.couple, torque_j = arm_j * action.couple;
  if (bending) torque_i = torque_i + action.moment, torque_j = torque_j - action.moment;
  to_rows(action.force, zero, batch.force + at);
  to_rows(torque_i, zero, batch.torque_i + at);
  to_rows(torque_j, zero, batch.torque_j + at);
  losses.damped = losses.damped + action.damped;
  losses.slipped = losses.slipped + action.slipped;
  const Lanes gap = action.half_gap + action.half_gap;
  return both(data.kn > zero, breaks(gap, memory.bond_slip, data));
}

template <bool may_touch, bool bending>
void advance(PairTable& pairs, BeadTable& beads, std::size_t first, std::size_t last,
             const LawNumbers<double>& law, LawParts parts, Chunk& chunk) {
  const Lanes::Tag tag;
  const Lanes zero = {hn::Zero(tag)};
  const Constants given = {
      {same(law.k_glass, zero), same(law.kt_glass, zero), same(law.friction, zero), same(law.damping, zero),
       same(law.dt, zero), same(law.half_dt, zero), same(law.half_damping_dt, zero)},
      parts};
  Losses losses = {zero, zero};
  PairBlock* const blocks = pairs.blocks.data();
  ContactBlock* const contacts = pairs.contacts.data() + chunk.first_contact - chunk.touchable;
  BendBlock* const bends = pairs.bends.data();
  double *const rows = beads.rows.data(), *const sums = beads.sums.data();
  Batch batch;
  for (std::size_t begin = first; begin < last; begin += kBatch) {
    const std::size_t end = std::min(begin + kBatch, last);
    for (std::size_t b = begin; b < end; ++b)
      read_motion<bending>(blocks[b], rows, 4 * kBlock * (b - begin), batch);
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(tag)) {
        const LaneMask breaking = advance_lanes<may_touch, bending>(
            blocks[b], may_touch ? contacts + b : nullptr, bending ? bends + b : nullptr, lane,
            4 * (kBlock * (b - begin) + lane), given, batch, losses);
        if (any(breaking)) note_breaks(breaking, kBlock * b + lane, chunk);
      }
    for (std::size_t b = begin; b < end; ++b) add_to_beads(blocks[b], sums, 4 * kBlock * (b - begin), batch);
  }
  chunk.damped += hn::GetLane(hn::SumOfLanes(tag, losses.damped.v));
  chunk.slipped += hn::GetLane(hn::SumOfLanes(tag, losses.slipped.v));
}

template <bool bending>
void advance(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
             LawParts parts) {
  advance<false, bending>(pairs, beads, chunk.first_block, chunk.touchable, law, parts, chunk);
  advance<true, bending>(pairs, beads, chunk.touchable, chunk.last_block, law, parts, chunk);
}

void AdvancePairs(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
                  LawParts parts) {
  if (parts.bending)
    advance<true>(pairs, beads, chunk, law, parts);
  else
    advance<false>(pairs, beads, chunk, law, parts);
}

void collect(BeadTable& beads, const Chunk& chunk) {
  const Row row;
  double* HWY_RESTRICT sums = beads.sums.data();
  for (const auto& incoming : chunk.incoming)
    for (std::size_t c = 0; c < kSumRow; c += hn::Lanes(row)) {
      double* HWY_RESTRICT from = sums + kSumRow * static_cast<std::size_t>(incoming.from) + c;
      double* HWY_RESTRICT to = sums + kSumRow * static_cast<std::size_t>(incoming.to) + c;
      hn::Store(hn::Add(hn::Load(row, to), hn::Load(row, from)), row, to);
      hn::Store(hn::Zero(row), row, from);
    }
}

void MoveBeads(BeadTable& beads, Chunk& chunk, double dt) {
  collect(beads, chunk);
  const Row row;
  const hn::Rebind<float, Row> listed_row;
  HWY_ALIGN float farthest[4] = {0.0F, 0.0F, 0.0F, 0.0F};
  const auto step = hn::Set(row, dt);
  for (std::size_t c = 0; c < 4; c += hn::Lanes(row)) {
    // The fourth numbers of a row stay as they are: the sums' are zero, and the position's is kept.
    HWY_ALIGN constexpr double moves[4] = {1.0, 1.0, 1.0, 0.0};
    const auto moving = hn::Mul(step, hn::Load(row, moves + c));
    auto reach = hn::Zero(listed_row);
    for (std::size_t k = chunk.first_bead; k < chunk.last_bead; ++k) {
      double* HWY_RESTRICT bead = beads.rows.data() + kBeadRow * k;
      double* HWY_RESTRICT sums = beads.sums.data() + kSumRow * k;
      const auto velocity =
          hn::MulAdd(hn::Set(row, bead[7]), hn::Load(row, sums + c), hn::Load(row, bead + 4 + c));
      const auto spin = hn::MulAdd(hn::Set(row, beads.step_over_inertia[k]), hn::Load(row, sums + 4 + c),
                                   hn::Load(row, bead + 8 + c));
      const auto position = hn::MulAdd(moving, velocity, hn::Load(row, bead + c));
      hn::Store(position, row, bead + c);
      hn::Store(velocity, row, bead + 4 + c);
      hn::Store(spin, row, bead + 8 + c);
      hn::Store(hn::Zero(row), row, sums + c);
      hn::Store(hn::Zero(row), row, sums + 4 + c);
      const float* HWY_RESTRICT listed = beads.listed_rows.data() + 4 * k;
      const auto moved = hn::Sub(hn::DemoteTo(listed_row, position), hn::Load(listed_row, listed + c));
      reach = hn::Max(reach, hn::Abs(hn::Mul(moved, hn::Set(listed_row, listed[3]))));
    }
    hn::Store(reach, listed_row, farthest + c);
  }
  for (int axis = 0; axis < 3; ++axis) chunk.farthest[axis] = farthest[axis];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pendular
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pendular {
namespace {
HWY_EXPORT(AdvancePairs);
HWY_EXPORT(MoveBeads);
}  // namespace

void advance_pairs(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
                   LawParts parts) {
  HWY_DYNAMIC_DISPATCH(AdvancePairs)(pairs, beads, chunk, law, parts);
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

}  // namespace pendular
#endif
