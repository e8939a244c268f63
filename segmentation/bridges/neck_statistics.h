#pragma once

// From the evidence of single crevices to which pairs have a bridge, and how thick it is.

#include <optional>
#include <span>
#include <vector>

#include "packing/packing.h"
#include "segmentation/bridges/crevice.h"

namespace pendular::segmentation {

/// All necks of a volume, lengths in voxels.
struct NeckPopulation {
  double contrast = 0.0;        ///< of the polymer against its surroundings, over that of the beads
  double sigma_contrast = 0.0;  ///< standard error
  double share = 0.0;           ///< of the pairs that have a neck
  double mean = 0.0, sd = 0.0;  ///< of neck radii, without errors of measurement
  double gain = 0.0;            ///< in log-likelihood over no polymer anywhere
};

/// What one crevice says, given the population.
struct NeckVerdict {
  double probability = 0.5;
  double radius = 0.0, sigma_radius = 0.0;  ///< of the neck, if there is one, voxels
};

/// Contrast and population that are likeliest for all crevices together: a share of the pairs has necks of
/// normally distributed radii and one contrast, the others none; by expectation and maximisation (Dempster et
/// al. 1977) in turn with the contrast. Nothing where the grey values do not show any polymer: a gain below
/// ten, or a contrast below four standard errors.
std::optional<NeckPopulation> neck_population(std::span<const NeckEvidence> crevices,
                                              std::span<const double> radii);

NeckVerdict neck_verdict(const NeckEvidence& crevice, double radius, const NeckPopulation& population);

/// Bridge and none such that the expected share of wrong ones among each is at most `false_discoveries`, the
/// surest first (Efron 2010, Large-Scale Inference, ch. 5: mean local false-discovery rate); the others stay
/// undetermined.
std::vector<BridgeState> neck_states(std::span<const double> probabilities, double false_discoveries);

}  // namespace pendular::segmentation
