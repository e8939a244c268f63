#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem_core/step/step_tables.h"

namespace pendular::dem_core {

/// Runs that are advanced side by side: one in each lane of a block, whose numbers stand side by side.
constexpr std::size_t kRuns = kBlock;

/// A bead in each run.
struct alignas(64) SideBead {
  BlockOf<double> x, y, z, vx, vy, vz, wx, wy, wz, radius;
};

/// Force and torque on it, in quanta.
struct alignas(64) SideSums {
  BlockOf<std::int64_t> fx, fy, fz, tx, ty, tz;
};

/// What it is moved by, and from where.
struct alignas(64) SideInertia {
  BlockOf<double> per_mass, per_inertia;  ///< dt/m × quantum of forces, dt/I × quantum of torques
  BlockOf<float> listed_x, listed_y, listed_z, per_margin_squared;
};

struct SideBeads {
  AlignedVector<SideBead> motion;  ///< two more, apart, are those of pairs that are no longer in use
  AlignedVector<SideSums> sums;
  AlignedVector<SideInertia> inertia;
};

/// Pairs, each in all runs: a pair that one of them lists.
struct SidePairs {
  struct Ends {
    std::uint32_t i, j;  ///< rows of beads
  };
  std::vector<Ends> ends;
  AlignedVector<PairColumns> columns;
  AlignedVector<ContactBlock> contacts;  ///< where the glass of the pairs may touch before the next listing
  AlignedVector<BendBlock> bends;        ///< where the law has bending
  std::vector<std::uint8_t> apart;       ///< of these, in which lanes it was apart in the last step
};

/// A platen in each run.
struct SidePlaten {
  AlignedVector<PlatenColumns> beads;  ///< of every row
  std::vector<std::uint32_t> near;     ///< rows that it may touch in some run before the next listing
  alignas(64) PlatenNumbers<BlockOf<double>> numbers = {};
};

/// LawNumbers and what a number has over one quantum, of each run.
struct alignas(64) SideLaw {
  BlockOf<double> k_glass, kt_glass, per_overlap, friction, damping, dt, half_dt, half_damping_dt;
  BlockOf<double> per_force, per_torque, per_energy;
};

/// What one step adds to the sums of each run.
struct alignas(64) SideTotals {
  BlockOf<std::int64_t> damped, slipped, bottom, top;  ///< in quanta
  BlockOf<double> farthest;                            ///< largest displacement over margin, squared
};

/// A bond that breaks.
struct SideBreak {
  std::size_t pair, run;
};

}  // namespace pendular::dem_core
