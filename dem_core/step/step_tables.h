#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "dem_core/step/aligned_vector.h"

namespace pendular::dem_core {

/// Pairs of one block: no register holds more.
constexpr std::size_t kBlock = 8;

/// One number of each pair of a block, side by side as a register wants them.
template <typename T>
using BlockOf = T[kBlock];

/// What eight pairs have of their own and remember.
struct alignas(64) PairColumns {
  BlockOf<float> kn, kt, break_limit, closing;
  BlockOf<double> rest, slip_x, slip_y, slip_z;
};

/// Eight pairs. Where a group has fewer left, pairs that never act fill the block up.
struct alignas(64) PairBlock {
  BlockOf<std::uint32_t> i, j;          ///< where their beads' rows begin in BeadTable::motion and spin
  BlockOf<std::uint32_t> sum_i, sum_j;  ///< where the rows they add to begin in BeadTable::sums
  PairColumns columns;
};

/// What the glass of eight pairs adds.
struct alignas(64) ContactBlock {
  BlockOf<double> touch, slip_x, slip_y, slip_z;
};

/// What the bending of eight bonds adds.
struct alignas(64) BendBlock {
  BlockOf<double> k_bend, k_twist, turn_x, turn_y, turn_z;
};

/// What a platen has and remembers of eight beads, or of one in eight runs.
struct alignas(64) PlatenColumns {
  BlockOf<double> relief, slip_x, slip_y, closing;
};

/// Eight beads that a platen may touch before the next listing. Those that fill a block up lie back from it
/// by a metre.
struct alignas(64) PlatenBlock {
  BlockOf<std::uint32_t> row;  ///< where their rows begin in BeadTable
  PlatenColumns columns;
};

/// What pairs that stand together in a table have in common.
enum class PairKind {
  apart,      ///< bonds whose glass cannot touch before the next listing
  touchable,  ///< bonds whose glass may
  loose       ///< without a bond
};

/// Squares of the distances at which the glass of eight pairs touches, and a billionth more.
struct alignas(64) ReachBlock {
  BlockOf<double> squared;
};

struct PairTable {
  AlignedVector<PairBlock> blocks;
  AlignedVector<ContactBlock> contacts;  ///< of the chunks' blocks whose glass may touch, one after the other
  std::vector<std::uint8_t> glass_apart;  ///< of these, in which lanes it was apart in the last step
  AlignedVector<ReachBlock> reaches;      ///< of the chunks' loose blocks, one after the other
  AlignedVector<BendBlock> bends;         ///< of all blocks, where the law has bending
};

/// Numbers in a row of a bead's motion, spin or sums: a cache line.
constexpr std::uint32_t kBeadRow = 8;

/// Three numbers of a row.
inline void put(double* row, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) row[axis] = v[axis];
}
inline Vec3 get(const double* row) {
  return {row[0], row[1], row[2]};
}

/// Beads as the kernels read them.
struct BeadTable {
  std::size_t size = 0;
  AlignedVector<double> motion;      ///< x y z R | vx vy vz dt/m × quantum of forces
  AlignedVector<double> spin;        ///< ωx ωy ωz R | dt/I × quantum of torques, 1/margin², and two more
  AlignedVector<float> listed_rows;  ///< x y z R when the pairs were listed
  /// Force and 0 | torque and 0, in quanta: a row per bead, which its own chunk adds to, then those that
  /// other chunks add to.
  AlignedVector<std::int64_t> sums;
};

/// Beads that are near in space, and the pairs that they own: a pair is owned by the chunk of the first of
/// its two rows, so a chunk reads and adds to its own beads and those of some later chunks only.
struct Chunk {
  std::size_t first_bead = 0, last_bead = 0;
  std::size_t first_block = 0;                           ///< of pairs whose kind is apart
  std::size_t touchable = 0, loose = 0, last_block = 0;  ///< of the other kinds
  std::size_t first_contact = 0;                         ///< contact block of the first touchable block
  std::size_t first_reach = 0;                           ///< reach block of the first loose block
  /// Sums that earlier chunks have made for beads of this one.
  struct Incoming {
    std::uint32_t from, to;
  };
  std::vector<Incoming> incoming;
  std::vector<std::uint32_t> foreign;  ///< rows of other chunks' beads that its pairs have, times kBeadRow
  AlignedVector<PlatenBlock> near_bottom, near_top;

  // What the chunk adds to the sums over the specimen in one step, in quanta.
  std::int64_t damped = 0, slipped = 0, bottom = 0, top = 0;
  double farthest = 0.0;                ///< largest displacement over margin since listing, squared
  std::vector<std::uint32_t> breaking;  ///< pairs whose bond breaks: block × kBlock + place in it
};

}  // namespace pendular::dem_core
