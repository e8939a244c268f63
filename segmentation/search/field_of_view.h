#pragma once

#include <optional>

#include "segmentation/search/grey_levels.h"
#include "segmentation/search/grid.h"

namespace pendular::segmentation {

/// The disc about the slices' middle that a reconstruction fills; beyond it there is one value, in all
/// slices.
struct FieldOfView {
  double x = 0.0, y = 0.0, radius = 0.0;  ///< voxels
  double value = 0.0;                     ///< of the voxels beyond it
  double voxels_beyond = 0.0;             ///< how many
};

/// None where the corners of the slices hold different values. Looks at some slices only.
std::optional<FieldOfView> field_of_view(const Volume& volume);

/// Takes the voxels beyond out of a histogram of all.
void leave_out(Histogram& histogram, const FieldOfView& view);

/// Gives nodes beyond the view the mean of those just within, as if what is there went on.
void fill_beyond(Grid<float>& grey, const FieldOfView& view);

}  // namespace pendular::segmentation
