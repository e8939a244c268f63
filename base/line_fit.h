#pragma once

#include <cstddef>
#include <span>

namespace pendular {

/// A straight line.
struct Line {
  double slope = 0.0, intercept = 0.0;
  double at(double x) const { return intercept + slope * x; }
};

/// Through points by least squares; level where all x are the same. x and y are of one length, at least one.
inline Line line_through(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) mx += x[k] / n, my += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mx) * (x[k] - mx);
    xy += (x[k] - mx) * (y[k] - my);
  }
  const double slope = xx > 0.0 ? xy / xx : 0.0;
  return {slope, my - slope * mx};
}

}  // namespace pendular
