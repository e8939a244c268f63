#pragma once

#include <vector>

#include "packing/packing.h"

namespace pendular {

/// Every pair of beads with a gap below `max_gap` (m), sorted by (i, j), as candidates: gap from centres and
/// diameters, and its standard error from those of the centres (along their line) and of the diameters,
/// σ² = σ_c,i² + σ_c,j² + (σ_D,i² + σ_D,j²)/4.
std::vector<Bridge> candidate_bridges(const std::vector<Bead>& beads, double max_gap);

/// What a table that lists bridges alone says of other pairs: those of its beads with a gap below `max_gap`
/// (m) that it does not list have none. Empty where the table also lists pairs in another state than
/// `bridge`.
std::vector<Bridge> pairs_without(const std::vector<Bead>& beads, const std::vector<Bridge>& listed,
                                  double max_gap);

/// Mean diameter of the beads, m; the D that cut-offs are given in.
double mean_diameter(const std::vector<Bead>& beads);

/// Centres and diameters as columns, m.
std::vector<Vec3> centres_of(const std::vector<Bead>& beads);
std::vector<double> diameters_of(const std::vector<Bead>& beads);

}  // namespace pendular
