#pragma once

#include <string>
#include <vector>

#include "packing/packing.h"

namespace pendular {

/// BadInput, opening with `where` and naming the beads, for: no bead, an id found twice, a centre or diameter
/// that no bead has (base/columns.h), and two centres closer than half the mean of their
/// diameters (a bead listed twice, or columns in different units).
void check_beads(const std::vector<Bead>& beads, const std::string& where);

/// The same for beads of which measurement does not explain that they overlap: by more than 5 % of their
/// diameter and five standard errors of the gap.
void check_overlaps(const std::vector<Bead>& beads, const std::string& where);

}  // namespace pendular
