#include "segmentation/bead_search.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "segmentation/polarity.h"

namespace pendular {
namespace {

Grid<std::uint8_t> mask_of(const Grid<float>& grey, double threshold, bool bright) {
  Grid<std::uint8_t> mask{grey.size, grey.factor, std::vector<std::uint8_t>(grey.values.size())};
  for_blocks(grey.values.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) mask.values[n] = (grey.values[n] > threshold) == bright;
  });
  return mask;
}

BeadSearch search_at(const Volume& volume, std::size_t factor, const GreyLevels& levels, BeadTone tone) {
  BeadSearch search;
  const Grid<float> grey = binned(volume, factor);
  stop_if_interrupted();
  search.container = find_container(grey, levels);
  const Grid<float> smooth = smoothed(grey, 0.7);
  stop_if_interrupted();
  search.bright = tone == BeadTone::automatic ? mean_edge_curvature(smooth, levels) > 0.0 : tone == BeadTone::bright;
  search.mask = mask_of(smooth, levels.threshold, search.bright);
  if (search.container) clear_outside(search.mask, *search.container);
  search.seeds = find_seeds(search.mask, 1.5 * static_cast<double>(factor));
  stop_if_interrupted();
  return search;
}

}  // namespace

BeadSearch search_beads(const Volume& volume, const GreyLevels& levels, BeadTone tone, std::optional<double> least_radius) {
  constexpr double least_share = 0.4, least_nodes_across = 8.0;
  BeadSearch search = search_at(volume, 2, levels, tone);
  double typical = typical_radius(search.seeds);
  if (typical < least_nodes_across) {
    search = search_at(volume, 1, levels, tone);
    typical = typical_radius(search.seeds);
  }
  search.least_radius = least_radius.value_or(least_share * typical);
  std::erase_if(search.seeds, [&](const Seed& seed) { return seed.radius < search.least_radius; });
  return search;
}

std::vector<Seed> search_missed(const Grid<std::uint8_t>& mask, const std::vector<Seed>& found, double least_radius) {
  Grid<std::uint8_t> rest = mask;
  const double factor = static_cast<double>(mask.factor);
  for (const Seed& seed : found) {
    const double radius = seed.radius + 0.5 * factor;
    std::array<long, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(0L, static_cast<long>(std::floor((seed.centre[axis] - radius) / factor)));
      high[axis] = std::min(static_cast<long>(mask.size[axis]) - 1, static_cast<long>(std::ceil((seed.centre[axis] + radius) / factor)));
    }
    for (long k = low[2]; k <= high[2]; ++k)
      for (long j = low[1]; j <= high[1]; ++j)
        for (long i = low[0]; i <= high[0]; ++i) {
          const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j), c = static_cast<std::size_t>(k);
          if ((mask.at(a, b, c) - seed.centre).squaredNorm() < radius * radius) rest.values[mask.index(a, b, c)] = 0;
        }
  }
  return find_seeds(rest, least_radius);
}

}  // namespace pendular
