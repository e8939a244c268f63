#pragma once

#include <vector>

#include "dem_core/observe/curve.h"

namespace pendular::blind {

/// The rows of a test as a logger keeps them: one wherever the platen has moved on by `step` of strain, by
/// straight lines between the rows given, loading, unloading and reloading each for itself, up to
/// `last_strain`. Strains are then the same for all tests of one course.
std::vector<CurveRow> logged(const std::vector<CurveRow>& rows, double step, double last_strain);

/// Those of the rows that strain farther than any before: no unloading, no reloading.
std::vector<CurveRow> first_loading(const std::vector<CurveRow>& rows);

}  // namespace pendular::blind
