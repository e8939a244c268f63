#pragma once

#include <string>

namespace pendular {

/// The values that a column of a table, or an array of a .vtp, may have.
struct Range {
  double lowest, highest;

  bool holds(double value) const { return value >= lowest && value <= highest; }  ///< NaN: no
};

/// By the column's name, which carries its unit: no specimen, bead or polymer is beyond. Lengths reach a
/// metre, stresses and moduli 10 TPa; standard deviations, diameters and counts are not negative;
/// probabilities and flags go from 0 to 1. A name without a unit that is known here is bounded by ±1e15.
Range range_of(const std::string& column);

/// BadInput, opening with `where` and `what`, for a number that is not in a range.
void require_in_range(const std::string& where, const std::string& what, const Range& range, double value);

}  // namespace pendular
