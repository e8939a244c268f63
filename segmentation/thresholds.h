#pragma once

namespace pendular::segmentation {

/// What decides in the segmentation: whether something is a bead, a wall, a ring, a neck, or suspect. Numbers
/// that size a computation (bins, blocks, steps) stand where they are used. In brackets the tests, named as
/// `ctest -R` takes them, and the rows of docs/segmentation.md that a threshold was set on.
struct SegmentationThresholds {
  // Search. Shares of the range of grey values unless said otherwise.
  double most_busy_spread = 0.2;   ///< a column's or slice's spread that only beads make [Segment]
  double least_busy_spread = 0.1;  ///< the same of beads that blur into each other [rows: 8 to 12 voxels]
  double piston_step = 0.15;       ///< step up of the mean that only a piston makes [Segment]
  double tube_step = 0.05;         ///< the same of a thin wall, on a circle [Segment.FinneysPacking]
  double least_sphericity = 0.02;  ///< below it bodies have run together [rows: 8 to 12 voxels]
  double well_resolved = 7.0;      ///< least typical radius, nodes [rows: 8 to 12 voxels]
  double refined_below = 5.5;  ///< typical radius, voxels, that asks for finer ones [rows: 8 to 12 voxels]
  double least_relative_radius = 0.25;  ///< over the typical one [Segment.FindsEveryBeadWhereDiametersVary]

  // Fits of beads.
  double least_contrast = 0.4;    ///< of a bead, over the classes' difference [OddVolumes, Segment]
  double least_explained = 0.4;   ///< share of a seen shell that a ball explains [OddVolumes.Pores]
  double least_separation = 0.7;  ///< of two balls, over the sum of their radii [Segment]
  double outlier_misfit = 0.15;   ///< residual beyond the noise, over contrast [OddVolumes.Pores]
  double foreign_patch = 4.5;     ///< robust standard deviations of a patch's mean [OddVolumes]
  double half_quality = 0.15;     ///< misfit over contrast at which `quality` is one half: its definition
  double uneven_core = 2.0;       ///< variance over the middle one, of cores with pores [OddVolumes.Pores]

  // Rings.
  double ring_sigmas = 5.0;       ///< of what both halves of the balls see alike [Rings]
  double ring_over_noise = 0.14;  ///< fainter rings cost less than taking them away [Rings; rows: rings]

  // Polymer and necks.
  double polymer_error = 0.015;    ///< standard error of centres, voxels, that asks for it [rows: noise 0.3]
  double polymer_contrast = 0.03;  ///< over the beads': with less there is none to know [rows: no contrast]
  double neck_gain = 10.0;         ///< log likelihood ratio of polymer against none [BridgeSearch]
  double neck_sigmas = 4.0;        ///< of the polymer's contrast [BridgeSearch]

  // Defects of an image.
  double padding_within = 0.01;  ///< of the voxels of the specimen's middle [Padding]
  double slice_rise = 1.25;      ///< change to the next slice over the usual one [OddVolumes.LostAndRepeated]
  double slice_over_next = 4.0;  ///< excess of a change over those beside it [OddVolumes.LostAndRepeated]
  double slice_alike = 0.3;      ///< spreads between the means before and after [OddVolumes.LostAndRepeated]
  double end_share = 0.002;      ///< of the voxels at one end of the grey values [OddVolumes.GreyValues]
  double end_over_next = 8.0;    ///< their count over that of the bins within [OddVolumes.GreyValues]
};

inline constexpr SegmentationThresholds kThresholds;

}  // namespace pendular::segmentation
