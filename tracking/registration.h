#pragma once

#include <optional>
#include <vector>

#include "tracking/frame.h"

namespace pendular::tracking {

/// Finds the frame from the constellations alone: any rotation and shift, a scale within a few per cent of
/// one, the specimen strained by some 10 % in between.
///
/// The surroundings of some beads of the first scan are looked for about all beads of the second, in any
/// orientation (Constellations). From the most like pair the match grows bead by bead (Following), across the
/// motion of single beads and bands. It is taken where it has few holes, six tenths of the places that it
/// leads to being filled and more of these where they are few, and reaches three tenths of the smaller scan:
/// a wrong start ends where it began. BadInput where none gets there: the beads are of another specimen, or
/// match those of the first scan in a mirror, which is said. The first scan's z is the specimen's axis.
///
/// `strain`: of the specimen along z, where it is known; see registration_of.
Registration register_scans(const std::vector<Bead>& before, const std::vector<Bead>& after,
                            std::optional<double> strain = std::nullopt);

}  // namespace pendular::tracking
