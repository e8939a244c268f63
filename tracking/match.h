#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "packing/packing.h"

namespace pendular::tracking {

/// A bead in two scans of one specimen, by its places in their tables.
struct BeadMatch {
  int before = 0, after = 0;
  double score = 0.0;  ///< share of its neighbours that are found again about it
};

struct MatchOptions {
  double reach = 2.5;  ///< how far beads may be from where the even motion brings them, mean diameters
};

/// Beads of one specimen before and after it was deformed, matched by their surroundings and diameters;
/// sorted by `before`. Both scans are in one frame (register_scans); `even` is the linear motion from the
/// first to the second that fits best.
///
/// A bead's constellation, the vectors to the beads within two diameters, is looked for about every bead of
/// the other scan within reach of where the even motion brings it. A random place has each neighbour by
/// chance with a probability of a few per cent, so that half a constellation is beyond chance. Beads whose
/// surroundings are torn apart (shear bands) are found in a second round, where the motion of matched
/// neighbours, extended linearly, leads to; last, beads that have come loose, where a single one of their
/// diameter is left within a diameter of there. A match that departs from its neighbours' motion by more than
/// half a diameter, or that two beads claim, is dropped.
std::vector<BeadMatch> match_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                                   const Eigen::Affine3d& even, const MatchOptions& options = {});

}  // namespace pendular::tracking
