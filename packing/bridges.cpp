#include "packing/bridges.h"

#include <cmath>

#include "packing/neighbours.h"

namespace pendular {

std::vector<Bridge> candidate_bridges(const std::vector<Bead>& beads, double max_gap) {
  std::vector<Bridge> bridges;
  for (const auto& [i, j] : pairs_within(centres_of(beads), diameters_of(beads), max_gap)) {
    const Bead &a = beads[static_cast<std::size_t>(i)], &b = beads[static_cast<std::size_t>(j)];
    Bridge bridge;
    bridge.i = i;
    bridge.j = j;
    bridge.gap = gap(a, b);
    bridge.sigma_gap =
        std::sqrt(a.sigma_centre * a.sigma_centre + b.sigma_centre * b.sigma_centre +
                  0.25 * (a.sigma_diameter * a.sigma_diameter + b.sigma_diameter * b.sigma_diameter));
    bridges.push_back(bridge);
  }
  return bridges;
}

double mean_diameter(const std::vector<Bead>& beads) {
  double sum = 0.0;
  for (const auto& bead : beads) sum += bead.diameter;
  return sum / static_cast<double>(beads.size());
}

std::vector<Vec3> centres_of(const std::vector<Bead>& beads) {
  std::vector<Vec3> centres;
  centres.reserve(beads.size());
  for (const auto& bead : beads) centres.push_back(bead.centre);
  return centres;
}

std::vector<double> diameters_of(const std::vector<Bead>& beads) {
  std::vector<double> diameters;
  diameters.reserve(beads.size());
  for (const auto& bead : beads) diameters.push_back(bead.diameter);
  return diameters;
}

}  // namespace pendular
