#include "dem_core/observe/avalanches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pendular::dem_core {
namespace {

constexpr double kReach = 3.0;  // mean diameters

/// The earliest event that each is linked to.
std::vector<std::size_t> linked(const std::vector<BreakEvent>& events, const AvalancheWindow& window) {
  std::vector<std::size_t> parent(events.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (std::size_t k = 0; k < events.size(); ++k)
    for (std::size_t before = k; before-- > 0;) {
      if (std::fabs(events[k].strain - events[before].strain) > window.strain) break;
      if ((events[k].place - events[before].place).norm() > window.distance) continue;
      const std::size_t a = root(k), b = root(before);
      parent[std::max(a, b)] = std::min(a, b);
    }
  for (std::size_t k = 0; k < events.size(); ++k) parent[k] = root(k);
  return parent;
}

}  // namespace

AvalancheWindow avalanche_window(const Simulation& simulation, double kn, double rate) {
  const auto& beads = simulation.beads;
  const double mass =
      std::accumulate(beads.mass.begin(), beads.mass.end(), 0.0) / static_cast<double>(beads.size());
  return {rate * kReach * std::sqrt(mass / kn), kReach * beads.mean_diameter()};
}

std::vector<Avalanche> avalanches(const std::vector<BreakEvent>& events, const AvalancheWindow& window) {
  const auto first = linked(events, window);
  std::vector<Avalanche> found;
  std::vector<std::size_t> of(events.size());  // event → avalanche
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (first[k] == k) {
      of[k] = found.size();
      found.push_back({events[k].strain, events[k].strain, 0, 0.0, Vec3::Zero(), 0.0});
    }
    of[k] = of[first[k]];
    Avalanche& avalanche = found[of[k]];
    avalanche.first_strain = std::min(avalanche.first_strain, events[k].strain);
    avalanche.last_strain = std::max(avalanche.last_strain, events[k].strain);
    avalanche.energy += events[k].energy;
    avalanche.centre += events[k].place;
    ++avalanche.breaks;
  }
  for (auto& avalanche : found) avalanche.centre /= avalanche.breaks;
  for (std::size_t k = 0; k < events.size(); ++k) {
    Avalanche& avalanche = found[of[k]];
    avalanche.extent = std::max(avalanche.extent, (events[k].place - avalanche.centre).norm());
  }
  return found;
}

}  // namespace pendular::dem_core
