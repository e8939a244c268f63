#pragma once

#include <optional>
#include <vector>

#include "packing/packing.h"
#include "segmentation/bead_fit.h"

namespace pendular {

/// What the grey values say of all bridges together. Lengths in m.
struct BridgeSummary {
  std::size_t pairs = 0;  ///< looked at
  std::size_t bridges = 0, none = 0, undetermined = 0;
  std::size_t unseen = 0;                       ///< of the undetermined: something else hides the crevice
  bool polymer_seen = false;                    ///< without it nothing is said of any pair
  double contrast = 0.0, sigma_contrast = 0.0;  ///< of the polymer, over that of the beads
  double share = 0.0;                           ///< of the pairs that have a bridge, as estimated
  double diameter = 0.0, diameter_sd = 0.0;     ///< of all necks, without errors of measurement
  double noise_scatter =
      1.0;  ///< of the evidence of pairs too far apart for bridges, over what noise makes of it
};

/// Looks for polymer in the crevice of each pair: sets probability, neck diameter and state, with bridges and
/// absences such that `false_discoveries` of either are wrong at most. `pairs` are of `fitted`'s beads, by
/// their places. The noise is what the evidence of pairs too far apart for bridges scatters by, but no less
/// than independent noise makes of it.
BridgeSummary measure_bridges(const Volume& volume, const FittedBeads& fitted,
                              const std::optional<Container>& container, double false_discoveries,
                              std::vector<Bridge>& pairs);

}  // namespace pendular
