#include "packing/diameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "packing/neighbours.h"

namespace pendular {
namespace {

constexpr double kLargestDeviate = 9.0;  // random_normal() reaches √(−2 ln 2⁻⁵⁴) = 8.65

std::vector<std::size_t> random_order(std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(random_bits(seed, a), a) < std::pair(random_bits(seed, b), b);
  });
  return order;
}

}  // namespace

std::vector<double> draw_diameters(std::span<const Vec3> centres, double mean, double relative_sd,
                                   std::uint64_t seed) {
  const double sd = relative_sd * mean;
  const std::vector<double> largest(centres.size(), mean + kLargestDeviate * sd);
  struct Neighbour {
    std::size_t index;
    double distance;
  };
  std::vector<std::vector<Neighbour>> neighbours(centres.size());
  std::vector<double> limits(centres.size(), std::numeric_limits<double>::max());
  for (const auto& [first, second] : pairs_within(centres, largest, 0.0)) {
    const auto i = static_cast<std::size_t>(first), j = static_cast<std::size_t>(second);
    const double distance = (centres[i] - centres[j]).norm();
    if (distance == 0.0) bad_input("beads {} and {} (counted from 0): found the same centre twice", i, j);
    for (const auto& [a, b] : {std::pair(i, j), std::pair(j, i)}) {
      neighbours[a].push_back({b, distance});
      limits[a] = std::min(limits[a], 1.5 * distance);
    }
  }

  std::vector<double> diameters(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) diameters[i] = std::min(mean, limits[i]);
  const std::uint64_t deviates = random_bits(seed, 1);
  for (const std::size_t i : random_order(centres.size(), random_bits(seed, 0))) {
    double diameter = std::min(std::max(mean + sd * random_normal(deviates, i), 0.5 * mean), limits[i]);
    // A few ulps less, so that rounding never makes an overlap.
    for (const auto& [j, distance] : neighbours[i])
      diameter = std::min(
          diameter, 2.0 * distance - diameters[j] - 8.0 * std::numeric_limits<double>::epsilon() * distance);
    diameters[i] = diameter;
  }
  return diameters;
}

}  // namespace pendular
