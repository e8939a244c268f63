#include "dem_core/drive/specimen_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "packing/check.h"

namespace pendular::dem_core {
namespace {

/// Height that the network around a bead spans.
struct Span {
  double lowest, highest;  ///< of its beads' surfaces, m
  int beads;
};

/// Of each network of pairs, at its lowest bead index; the others are of single beads.
std::vector<Span> networks(const Simulation& simulation) {
  const auto& beads = simulation.beads;
  std::vector<std::size_t> parent(beads.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (const auto& pair : simulation.pairs) {
    const std::size_t a = root(pair.i), b = root(pair.j);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<Span> spans;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const double z = beads.position[k].z();
    spans.push_back({z - beads.radius[k], z + beads.radius[k], 1});
    const std::size_t first = root(k);
    if (first == k) continue;
    Span& whole = spans[first];
    whole.lowest = std::min(whole.lowest, spans[k].lowest);
    whole.highest = std::max(whole.highest, spans[k].highest);
    ++whole.beads;
  }
  return spans;
}

void check_joined(const Simulation& simulation, double max_strain) {
  const auto spans = networks(simulation);
  const auto best = std::max_element(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    return a.highest - a.lowest < b.highest - b.lowest;
  });
  const double diameter = simulation.beads.mean_diameter();
  const double height = simulation.initial_height, spanned = best->highest - best->lowest;
  if (height - spanned <= max_strain * height + diameter) return;
  bad_input(
      "packing: no network of bonds and touching beads joins the platens: found at most {:.4g} of the {:.4g} "
      "um of height in one network (of {} beads from z = {:.4g} to {:.4g} um), expected all but the platen's "
      "travel",
      1e6 * spanned, 1e6 * height, best->beads, 1e6 * best->lowest, 1e6 * best->highest);
}

}  // namespace

void check_specimen(const Packing& packing, const Simulation& simulation, double max_strain) {
  check_overlaps(packing.beads, "packing");
  check_joined(simulation, max_strain);
}

}  // namespace pendular::dem_core
