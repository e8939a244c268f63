#pragma once

#include <vector>

#include "diagnosis/experiment/observation.h"

namespace pendular::diagnosis {

/// Columns of evenness(): where pairs are, over the specimen's size, from its middle, and the cosine of their
/// direction to the axis.
inline constexpr const char* kPlaceColumns[] = {"across_x", "across_y", "along_z", "cosine"};

/// Probability that chance alone, which is alike everywhere, makes values, one per pair, depend on place and
/// direction as much as these do: Rao's score test (1948) of a regression on the place's coordinates, their
/// squares and products, and the squared cosine, n R² against χ². For values of 0 and 1 as for normal ones.
/// NaN rows do not count. 1 where fewer than `least` are left, or, of 0 and 1, are of the rarer, and where
/// what depends on place has a root mean square of no more than `tolerated`.
double evenness(const Columns& places, const std::vector<double>& values, double tolerated,
                std::size_t least = 20);

}  // namespace pendular::diagnosis
