#pragma once

#include <vector>

#include "packing/packing.h"

namespace pendular {

/// Which gaps belong to beads that touch, where errors of measurement hide it.
///
/// Touching beads are measured to overlap as often as to be apart, by a normal error about zero; behind them
/// lie pairs that are truly apart, as many per standard error as are seen at three to six of them. A pair
/// touches where the first is the likelier; one that overlaps always does.
struct TouchLikelihood {
  double touching = 0.0;         ///< pairs that touch, as estimated from those that overlap
  double apart_per_sigma = 0.0;  ///< pairs that do not, per standard error of the gap

  bool touches(double gap, double sigma) const;
};
TouchLikelihood touch_likelihood(const std::vector<Bead>& beads);

/// The likeliest beads, given that none overlap, that as many pairs touch as touch_likelihood() estimates,
/// and that those touch the flat ends along z which likely do, where at least five lie on one: centres and
/// diameters moved as little as can be, in units of their stated standard errors (Hildreth 1957, Naval Res.
/// Logist. Q. 4, 79: projections in that metric). First no pair overlaps any more; then the nearest are
/// closed. Beads without stated errors stay where they are.
std::vector<Bead> closed_contacts(std::vector<Bead> beads);

/// Whether a pair's glass touches: to rounding, or where its errors are stated to the hundredth of them to
/// which contacts are closed. `diameter`: mean of the beads', m.
bool touches(const Bridge& pair, double diameter);

/// Pairs of beads that touch.
std::size_t touching_pairs(const std::vector<Bead>& beads);

}  // namespace pendular
