#pragma once

#include <optional>
#include <string>
#include <vector>

#include "packing/packing.h"
#include "segmentation/bridges/bridge_search.h"
#include "segmentation/search/bead_search.h"
#include "volume/volume.h"

namespace pendular::segmentation {

struct SegmentOptions {
  double cutoff = 0.064;                 ///< candidate bridges have gaps below cutoff × mean diameter
  BeadTone tone = BeadTone::automatic;   ///< of the beads against what surrounds them
  std::optional<double> least_diameter;  ///< m; none: a quarter of the typical one
  std::optional<BridgeOptions> bridges;  ///< look for polymer between candidates
};

/// A tomogram taken apart. Lengths in m, positions in the volume's own frame.
struct Segmentation {
  std::vector<Bead> beads;                ///< ids from 1, by rising z
  std::vector<Bridge> bridges;            ///< candidates, or measured ones
  std::optional<BridgeSummary> measured;  ///< of the bridges, where they were looked for
  std::vector<Bead> grains;  ///< bodies too irregular for a ball; place and inscribed diameter, quality 0
  std::optional<Specimen> specimen;  ///< the inside of the container, where one is seen
  GreyLevels levels;
  bool bright_beads = true;
  double porosity =
      0.0;  ///< share of voxels on the air side of the threshold, in the specimen or else the volume
  double blur = 0.0;               ///< standard deviation of the point spread with the voxel's own, m
  double noise = 0.0;              ///< standard deviation, over the classes' difference
  double noise_correlation = 0.0;  ///< of neighbouring voxels
  double rings = 0.0;              ///< taken away, root mean square over the classes' difference
  std::size_t rejected = 0;        ///< places looked at that turned out to be no bead
  std::vector<std::string> warnings;
};

/// Beads by seeds and a fit of each one's blurred edge in the raw grey values (segmentation/fit/bead_fit.h),
/// with standard errors that account for correlated noise, and the pairs near enough for a bridge. `quality`
/// is 1/(1 + (m/0.15)²), m the model's misfit beyond the noise over the bead's contrast. Padding
/// (search/padding.h) is no part of the picture. BadInput where there is no bead.
Segmentation segment(const Volume& volume, const SegmentOptions& options = {});

/// Number of the bead for each voxel of bead material (its place in `beads`, from 1; the grains' follow), 0
/// elsewhere, in padding and outside the specimen. A voxel belongs to the body whose surface is nearest, |x −
/// c| − R least. uint16, or uint32 beyond 65,535 bodies.
Volume label_volume(const Volume& volume, const Segmentation& segmentation);

}  // namespace pendular::segmentation
