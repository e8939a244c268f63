#pragma once

#include <vector>

#include "packing/packing.h"

namespace pendular {

/// Beads found, held against the beads that are there.
struct BeadComparison {
  std::size_t truth = 0, found = 0;
  std::size_t matched = 0;                                     ///< true beads with a found one
  std::size_t invented = 0;                                    ///< found beads without a true one
  Vec3 centre_bias = Vec3::Zero(), centre_rms = Vec3::Zero();  ///< of matched beads, per axis, m
  double diameter_bias = 0.0, diameter_rms = 0.0;              ///< found − true, m
};

/// A found bead matches the true bead whose centre is nearest, if nearer than a quarter of that bead's
/// diameter; each true bead is matched at most once, by the nearest.
BeadComparison compare_beads(const std::vector<Bead>& truth, const std::vector<Bead>& found);

}  // namespace pendular
