#pragma once

#include "dem_core/law/platen.h"
#include "dem_core/step/quanta.h"
#include "dem_core/step/side_by_side_tables.h"
#include "dem_core/step/step_tables.h"

namespace pendular::dem_core {

// A platen and the beads near it in one step, compiled for several instruction sets: the beads of one
// specimen, or one bead of several runs at a time.

/// Sums in quanta.
struct PlatenTotals {
  std::int64_t force = 0;  ///< on the platen
  std::int64_t damped = 0, slipped = 0;
};
PlatenTotals press_beads(AlignedVector<PlatenBlock>& near, BeadTable& beads,
                         const PlatenNumbers<double>& platen, LawParts parts, const PerQuantum& per);

/// Adds to the totals of each run, of the force on the platen to `force`.
void press_side_by_side(SidePlaten& platen, SideBeads& beads, const SideLaw& law, LawParts parts,
                        BlockOf<std::int64_t>& force, SideTotals& totals);

}  // namespace pendular::dem_core
