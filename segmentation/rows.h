#pragma once

#include <optional>
#include <utility>

#include "packing/packing.h"
#include "volume/volume.h"

namespace pendular::segmentation {

/// The voxels [first, last) of row (j, k) whose centres lie in the specimen; without one, the whole row.
std::pair<std::size_t, std::size_t> row_within(const Volume& volume, const std::optional<Specimen>& specimen,
                                               std::size_t j, std::size_t k);

/// Share of the voxels in the specimen that lie on the air side of the threshold.
double porosity_of(const Volume& volume, const std::optional<Specimen>& specimen, double threshold,
                   bool bright_beads);

}  // namespace pendular::segmentation
