#pragma once

#include <vector>

#include "diagnosis/inference/calibration.h"

namespace pendular::diagnosis {

/// Some of the replayed runs.
using Cases = std::vector<const Replayed*>;

/// Runs of one effect.
Cases singles_of(const Cases& cases);

/// Runs of one effect that go no farther than another member's at the same sign. The response to others is
/// extrapolated where their member is left out, which that to a measured specimen's effect need not be.
Cases spanned(const Cases& singles);

/// Whether a set is right: it holds the truth, or what stands for it where it is not told apart.
bool right(const AmbiguitySet& set, const Replayed& one, const Correction& correction);

/// |θ| that divides runs best into those that are told from none with this share and more, the larger ones,
/// and those that are not: where the sum over the larger ones of what they have beyond the share is largest,
/// which is where an isotonic regression passes it. Infinite where it does at no magnitude.
double least_told(std::vector<ReplayedMagnitude> runs, double share);

/// What these runs show of temperatures, levels, `unknown`, intervals and limits (promise_of()). Replayed
/// sets are right with this confidence.
Correction learn(const Cases& cases, double confidence, const Misfit& misfit);

}  // namespace pendular::diagnosis
