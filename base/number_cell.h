#pragma once

#include <fmt/format.h>

#include <cmath>

namespace pendular {

/// A number of a row that is formatted as a whole: by the specification of a double, empty where it is not
/// finite.
struct NumberCell {
  double value;
};

}  // namespace pendular

/// @cond Doxygen looks for fmt's own template.
template <>
struct fmt::formatter<pendular::NumberCell> : fmt::formatter<double> {
  template <typename Context>
  auto format(const pendular::NumberCell& cell, Context& context) const {
    return std::isfinite(cell.value) ? fmt::formatter<double>::format(cell.value, context) : context.out();
  }
};
/// @endcond
