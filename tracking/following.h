#pragma once

#include <optional>
#include <vector>

#include "tracking/surroundings.h"

namespace pendular::tracking {

/// Which bead of the second scan each bead of the first is; −1: none known.
using Partners = std::vector<int>;

/// Beads next to matched ones, matched by where the motion of these leads. Both scans in one frame: turned
/// against each other by some degrees at most. References must outlive it.
class Following {
 public:
  Following(const std::vector<Bead>& before, const std::vector<Bead>& after);

  /// Where the motion of matched neighbours, surfaces within 1.5 mean diameters, extended linearly, brings a
  /// bead (m); nothing where there are fewer than five. Neighbours in `without` do not count.
  std::optional<Vec3> led_to(const Partners& partners, std::size_t bead,
                             const std::vector<bool>& without = {}) const;

  /// Matches beads to what is left within `reach` (mean diameters) of where they are led to, the nearest
  /// first; how many more there are. `only`: where no other bead that is left could be meant.
  std::size_t extend(Partners& partners, double reach, bool only) const;

  /// Takes matches away that lie farther than `reach` (mean diameters) from where they are led to, or that
  /// nothing leads to.
  void drop_departures(Partners& partners, double reach) const;

  const BeadGrid& grid_after() const { return grid_; }
  double diameter() const { return diameter_; }  ///< mean, of the first scan, m

 private:
  const std::vector<Bead>&before_, &after_;
  double diameter_;
  BeadGrid grid_;
  std::vector<std::vector<int>> surroundings_;
};

}  // namespace pendular::tracking
