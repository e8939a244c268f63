#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "packing/packing.h"

namespace pendular::tracking {

/// Beads by the cells of a grid: which of them lie near a place. Keeps no reference to the beads.
class BeadGrid {
 public:
  /// Cells are cubes of `edge` (m), or larger where beads lie so far apart that there were more than sixteen
  /// cells for each.
  BeadGrid(const std::vector<Bead>& beads, double edge);

  /// Calls f(bead, distance) for every bead whose centre lies within `reach` (m) of a place.
  template <typename Function>
  void near(const Vec3& place, double reach, const Function& f) const {
    std::array<long, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = cell(place[axis] - reach, axis), high[axis] = cell(place[axis] + reach, axis);
      if (high[axis] < 0 || low[axis] >= cells_[axis]) return;
      low[axis] = low[axis] < 0 ? 0 : low[axis];
      high[axis] = high[axis] < cells_[axis] ? high[axis] : cells_[axis] - 1;
    }
    for (long x = low[0]; x <= high[0]; ++x)
      for (long y = low[1]; y <= high[1]; ++y)
        for (long z = low[2]; z <= high[2]; ++z) {
          const auto at = static_cast<std::size_t>((x * cells_[1] + y) * cells_[2] + z);
          for (std::size_t n = first_[at]; n < first_[at + 1]; ++n)
            if (const double d = (centres_[n] - place).norm(); d <= reach) f(beads_[n], d);
        }
  }

 private:
  long cell(double coordinate, int axis) const;

  double edge_;
  Vec3 origin_ = Vec3::Zero();
  std::array<long, 3> cells_{1, 1, 1};
  std::vector<std::size_t> first_;  ///< of each cell, in the two below, which are sorted by cell
  std::vector<int> beads_;
  std::vector<Vec3> centres_;
};

/// For each bead those whose surfaces lie within `gap` (m) of its own, in ascending order.
std::vector<std::vector<int>> neighbours_within(const std::vector<Bead>& beads, double gap);

/// Whether two measurements may be of one bead by their diameters: within five standard errors and 0.2 % of
/// `mean_diameter`, which a bead may differ by from scan to scan. Where no error is stated, always.
bool alike(const Bead& a, const Bead& b, double mean_diameter);

}  // namespace pendular::tracking
