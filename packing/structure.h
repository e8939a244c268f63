#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "packing/packing.h"

namespace pendular {

/// How beads and bridges lie to each other. Lengths in m.
struct Structure {
  /// Radial distribution function over r/D, in shells of 0.02 D up to 3 D: other beads at distance r from
  /// beads so far inside that the shell is whole, over as many at random. Empty where fewer than 20 beads
  /// are.
  std::vector<double> r_over_d, g;

  /// Where g(r) has its first peak, the highest between 0.8 and 1.2 D: what beads that touch are apart, to
  /// about a hundredth. 0 where none rises above 1.5.
  double first_peak = 0.0;

  /// Volume fraction in ten slabs of equal height, from below.
  std::vector<double> slab_middle, slab_fraction;

  double bridges = 0.0;  ///< that are counted: in state bridge or candidate, an end inside
  double cos2 = 0.0,
         cos2_error = 0.0;  ///< mean squared cosine to the axis, 1/3 without direction; its standard error
  std::vector<std::size_t> orientation;  ///< bridges by |cos| to the axis, ten bins from 0 to 1

  double neck_diameter = 0.0, neck_sd = 0.0;  ///< of bridges with a known neck; 0: none
  double polymer_volume = 0.0;                ///< of these, cylinders less both beads, m³

  /// Bridges whose necks meet that of another bridge on one of their beads, where liquid would flow together
  /// (the funicular onset); of those with known necks.
  std::size_t meeting = 0;
};

Structure structure_of(const Packing& packing);

/// Lengths in µm, as the keys say.
nlohmann::ordered_json to_json(const Structure& structure);

}  // namespace pendular
