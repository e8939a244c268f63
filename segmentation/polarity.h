#pragma once

#include "segmentation/grey_levels.h"
#include "segmentation/grid.h"

namespace pendular {

/// Mean curvature of the interface between the two classes, weighted by edge strength, in 1/node:
/// Σ |∇g| κ / Σ |∇g| with κ = −∇·(∇g/|∇g|), over nodes where |∇g| tells of an edge rather than of noise.
/// Positive where bright bodies bulge (bright beads), negative where dark ones do.
double mean_edge_curvature(const Grid<float>& smooth_grey, const GreyLevels& levels);

}  // namespace pendular
