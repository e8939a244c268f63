#include "dem_core/observe/lateral_strain.h"

#include <algorithm>
#include <numeric>

namespace pendular::dem_core {
namespace {

using Lateral = Eigen::Vector2d;

std::vector<char> still_bonded(const Simulation& simulation) {
  std::vector<char> bonded(simulation.beads.size(), 0);
  for (const auto& bond : simulation.bonds)
    if (!bond.broken) bonded[bond.i] = bonded[bond.j] = 1;
  return bonded;
}

Lateral mean_of(const std::vector<Vec3>& points, const std::vector<std::size_t>& which) {
  Lateral sum = Lateral::Zero();
  for (std::size_t k : which) sum += points[k].head<2>();
  return sum / static_cast<double>(which.size());
}

/// Beads that were the middle third's outer ones at the start.
std::vector<std::size_t> outer_beads(const BeadStates& beads) {
  std::vector<std::size_t> all(beads.size()), outer;
  std::iota(all.begin(), all.end(), 0);
  const Lateral axis = mean_of(beads.start, all);
  const double diameter = beads.mean_diameter();
  const auto from_axis = [&](std::size_t k) { return (beads.start[k].head<2>() - axis).norm(); };
  const auto [lowest, highest] = std::minmax_element(
      beads.start.begin(), beads.start.end(), [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  const double third = (highest->z() - lowest->z()) / 3.0, from = lowest->z() + third;
  double outermost = 0.0;
  for (std::size_t k : all) {
    if (beads.start[k].z() < from || beads.start[k].z() > from + third) continue;
    outer.push_back(k);
    outermost = std::max(outermost, from_axis(k));
  }
  std::erase_if(outer, [&](std::size_t k) { return from_axis(k) < outermost - diameter; });
  return outer;
}

}  // namespace

double lateral_strain(const Simulation& simulation) {
  const auto& beads = simulation.beads;
  const auto bonded = still_bonded(simulation);
  auto outer = outer_beads(beads);
  std::erase_if(outer, [&](std::size_t k) { return !bonded[k]; });
  if (outer.size() < 3) return 0.0;
  const Lateral start = mean_of(beads.start, outer), now = mean_of(beads.position, outer);
  double expansion = 0.0, square = 0.0;
  for (std::size_t k : outer) {
    const Lateral r = beads.start[k].head<2>() - start;
    const Lateral u = beads.position[k].head<2>() - now - r;
    expansion += u.dot(r);
    square += r.squaredNorm();
  }
  return square > 0.0 ? expansion / square : 0.0;
}

}  // namespace pendular::dem_core
