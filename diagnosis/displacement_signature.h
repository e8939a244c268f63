#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/features.h"

namespace pendular::diagnosis {

/// What the displacements of tracked beads (columns of a `displacements` observation) come to. All are
/// differences without unit; the platen moves along z.
///   bulk_strain_share   strain of the beads' mean motion along z over the platen's: less than one where
///                       compliance or the ends take a part
///   radial_share        radial expansion of the mean motion over the platen's strain
///   tilt_share          gradient of u_z across the section over the platen's strain
///   wandering           scatter about the affine motion over strain × bead spacing
/// From the last strain of the columns. Nothing where the beads are fewer than twenty there.
std::vector<std::pair<std::string, double>> displacement_signature(const Columns& columns);

}  // namespace pendular::diagnosis
