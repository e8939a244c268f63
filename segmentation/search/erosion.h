#pragma once

#include <cstddef>
#include <cstdint>

#include "segmentation/search/grid.h"

namespace pendular::segmentation {

/// Sets nodes of a mask to zero but those with `reach` nodes of it to all sides, in a cube; beyond the grid
/// there may be anything.
void erode(Grid<std::uint8_t>& mask, std::size_t reach);

}  // namespace pendular::segmentation
