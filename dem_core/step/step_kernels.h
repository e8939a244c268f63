#pragma once

#include <string>
#include <vector>

#include "dem_core/law/law_parameters.h"
#include "dem_core/step/quanta.h"
#include "dem_core/step/step_tables.h"

namespace pendular::dem_core {

/// The two inner loops of a time step, compiled for several instruction sets; the best that the machine has
/// is chosen when the program runs.

/// Advances the pairs of a chunk: springs, losses, breaks; adds their forces to the sums.
void advance_pairs(PairTable& pairs, BeadTable& beads, Chunk& chunk, const LawNumbers<double>& law,
                   LawParts parts, const PerQuantum& per);

/// Collects the sums of a chunk's beads, clears them, and moves the beads: leapfrog.
void move_beads(BeadTable& beads, Chunk& chunk, double dt);

/// Instruction sets that this program holds and this machine has, best first, by Highway's names.
std::vector<std::string> instruction_sets();

/// Uses the named one from now on. BadInput where this machine or program lacks it.
void use_instruction_set(const std::string& name);

}  // namespace pendular::dem_core
