#pragma once

#include <optional>
#include <vector>

#include "packing/packing.h"
#include "segmentation/fit/bead_fit.h"

namespace pendular::segmentation {

struct BridgeOptions {
  double false_discoveries =
      0.05;                ///< largest expected share of wrong ones among bridges, and among absences
  bool calibrate = false;  ///< put necks into the picture and see which are found
};

/// What became of necks of one size that were put into the picture. Lengths in m.
struct InjectedNecks {
  double diameter = 0.0;
  std::size_t injected = 0;
  double found = 0.0;      ///< share that is said to be a bridge
  double measured = 0.0;   ///< mean diameter of those
  double rms_error = 0.0;  ///< of it
};

/// What the grey values say of all bridges together. Lengths in m.
struct BridgeSummary {
  std::size_t pairs = 0;  ///< looked at
  std::size_t bridges = 0, none = 0, undetermined = 0;
  std::size_t unseen = 0;                       ///< of the undetermined: something else hides the crevice
  bool polymer_seen = false;                    ///< without it nothing is said of any pair
  double contrast = 0.0, sigma_contrast = 0.0;  ///< of the polymer, over that of the beads; where none is
                                                ///< seen, of what is in all crevices together
  double share = 0.0;                           ///< of the pairs that have a bridge, as estimated
  double diameter = 0.0, diameter_sd = 0.0;     ///< of all necks, without errors of measurement
  double noise_scatter =
      1.0;  ///< of the evidence of pairs too far apart for bridges, over what noise makes of it
  std::vector<InjectedNecks> injected;  ///< where asked for; empty where too few pairs have no bridge
};

/// Looks for polymer in the crevice of each pair: sets probability, neck diameter and state. `pairs` are of
/// `fitted`'s beads, by their places. The noise is what the evidence of pairs too far apart for bridges
/// scatters by, but no less than independent noise makes of it.
BridgeSummary measure_bridges(const Volume& volume, const FittedBeads& fitted,
                              const std::optional<Container>& container, const BridgeOptions& options,
                              std::vector<Bridge>& pairs);

}  // namespace pendular::segmentation
