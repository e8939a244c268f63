#pragma once

#include <optional>
#include <vector>

#include "packing/packing.h"

namespace pendular {

/// What gaps of touching beads have without any error of measurement, over the diameter: mean and standard
/// deviation. Beads of a real or simulated packing overlap and part by some thousandths where they touch.
inline constexpr double kTouchingGap = 0.0025, kTouchingScatter = 0.004;

/// How the gaps of touching beads are distributed in tables of measured beads: about zero, and as wide as
/// the stated errors say, unless diameters are biased or errors are not stated in full.
struct ContactPeak {
  double position = 0.0;  ///< mean gap of pairs that touch, m
  double scatter = 0.0;   ///< standard deviation of it, m
  double stated = 0.0;    ///< what the beads' stated errors make of it, rms, m; 0: none are stated
  double pairs = 0.0;     ///< how many pairs touch
  double diameter = 0.0;  ///< mean of the beads', m

  double sigma_position() const;  ///< standard errors
  double sigma_scatter() const;
};

/// Of all the tables together: the peak of the gaps between −20 and 20 % of the mean diameter, as a normal
/// distribution of pairs that touch before one of pairs that do not, whose density beyond the peak is even,
/// by expectation and maximisation (Dempster et al. 1977) from several widths, the likeliest being taken.
/// Nothing where fewer than 50 pairs touch or no peak stands out.
std::optional<ContactPeak> contact_peak(const std::vector<std::vector<Bead>>& tables);

}  // namespace pendular
