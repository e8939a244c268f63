#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "segmentation/search/container.h"
#include "segmentation/search/grey_levels.h"
#include "segmentation/search/grid.h"
#include "segmentation/search/seeds.h"

namespace pendular::segmentation {

enum class BeadTone { automatic, bright, dark };

/// Where beads may be, and what was found on the way.
struct BeadSearch {
  Histogram histogram;      ///< of all voxels but those beyond the reconstruction's field of view
  GreyLevels levels;        ///< within the container, where there is one
  Grid<std::uint8_t> mask;  ///< 1: bead material, within the container
  std::vector<Seed> seeds;
  bool bright = true;         ///< beads are brighter than what surrounds them
  double sphericity = 0.0;    ///< of the bodies in a part of the volume, 0 to 1
  double least_radius = 0.0;  ///< smallest seed kept, voxels
  std::optional<Container> container;
};

/// Share of a search's seeds, or of a sample of them, with a spherical boundary.
using BallShare = std::function<double(const BeadSearch&)>;

/// Whether the sphericity is a packing's, not that of irregular grains, noise, or beads run together.
bool mostly_spherical(const BeadSearch& search);

/// Whether voxels half as long, eight times as many, are no burden: in volumes of up to 2²⁶ voxels.
bool may_refine(const Volume& volume);

/// Looks for beads on the volume reduced by a power of two, lightly smoothed against noise: twofold, more
/// where that leaves more than 2²⁸ nodes, and finer where the typical bead is less than fourteen nodes
/// across. The tone, where it is automatic, is that of the class for which this product, the sphericity, is
/// greater: the share `balls_among` its bodies, and the share of its volume that their inscribed balls fill;
/// judged where grey values vary most. Volumes that may be refined are also looked at on finer grids, down to
/// half a voxel (by cubics), where nothing is spherical or beads are still too small. `least_radius`
/// (voxels): leave out what is smaller; without it, what is below a quarter of the typical radius.
BeadSearch search_beads(const Volume& volume, BeadTone tone, std::optional<double> least_radius,
                        const BallShare& balls_among);

/// Seeds in what the balls leave of the mask, at least `least_radius` voxels in radius: beads that were
/// missed.
std::vector<Seed> search_missed(const Grid<std::uint8_t>& mask, const std::vector<Seed>& found,
                                double least_radius);

}  // namespace pendular::segmentation
