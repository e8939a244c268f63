#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/kinds/features.h"

namespace pendular::diagnosis {

/// What the displacements of tracked beads (columns of a `displacements` observation at one strain, without
/// rigid motion and scale) come to. All are differences without unit; the platen moves along z.
///   deviatoric_share    strain along z less that across it, of the beads' mean motion over the platen's:
///   less
///                       than without it where compliance or the ends take a part
///   tilt_share          gradient of u_z across the section over the platen's strain
///   wandering           scatter about the affine motion over strain × bead spacing
/// Nothing where the beads are fewer than twenty.
std::vector<std::pair<std::string, double>> displacement_signature(const Columns& columns);

}  // namespace pendular::diagnosis
