#pragma once

#include <vector>

#include "dem_core/law/law_parameters.h"
#include "dem_core/step/side_by_side_tables.h"

namespace pendular::dem_core {

/// The two loops of a time step of several runs, compiled for several instruction sets: operation by
/// operation those of step_kernels.h, on one pair of all runs at a time.

/// Advances pairs: springs, losses, breaks; adds their forces to the sums. Loose pairs that are apart in all
/// runs, and were, are passed over: they neither do nor remember anything.
void advance_side_by_side(SidePairs& pairs, PairKind kind, SideBeads& beads, const SideLaw& law,
                          LawParts parts, SideTotals& totals, std::vector<SideBreak>& breaking);

/// Moves the beads by their sums, and clears these.
void move_side_by_side(SideBeads& beads, std::size_t size, const SideLaw& law, SideTotals& totals);

}  // namespace pendular::dem_core
