#include "packing/bridges.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

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

std::vector<Bridge> pairs_without(const std::vector<Bead>& beads, const std::vector<Bridge>& listed,
                                  double max_gap) {
  if (std::any_of(listed.begin(), listed.end(),
                  [](const Bridge& b) { return b.state != BridgeState::bridge; }))
    return {};
  std::set<int> joined;
  std::set<std::pair<int, int>> known;
  for (const Bridge& b : listed) {
    joined.insert({b.i, b.j});
    known.insert(std::minmax(b.i, b.j));
  }
  std::vector<Bridge> without = candidate_bridges(beads, max_gap);
  std::erase_if(without, [&](const Bridge& b) {
    return !joined.contains(b.i) || !joined.contains(b.j) || known.contains({b.i, b.j});
  });
  for (Bridge& b : without) b.state = BridgeState::none, b.probability = 0.0;
  return without;
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
