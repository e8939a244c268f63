#include "segmentation/seeds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "base/parallel.h"

namespace pendular {
namespace {

/// A part of a grid: nodes from `low` to below `high`.
struct Box {
  std::array<std::size_t, 3> low{}, high{};
};

/// What the mask takes up in slices [from, to), and a layer of nodes around it; none if nothing.
std::optional<Box> occupied(const Grid<std::uint8_t>& mask, std::size_t from, std::size_t to) {
  std::array<std::size_t, 2> least{mask.size[0], mask.size[1]}, greatest{0, 0};
  for (std::size_t k = from; k < to; ++k)
    for (std::size_t j = 0; j < mask.size[1]; ++j) {
      const auto* row = mask.values.data() + mask.index(0, j, k);
      const auto* first = static_cast<const std::uint8_t*>(std::memchr(row, 1, mask.size[0]));
      if (!first) continue;
      const auto* last = static_cast<const std::uint8_t*>(::memrchr(row, 1, mask.size[0]));
      least = {std::min<std::size_t>(least[0], first - row), std::min(least[1], j)};
      greatest = {std::max<std::size_t>(greatest[0], last - row), std::max(greatest[1], j)};
    }
  if (least[1] == mask.size[1]) return std::nullopt;
  Box box{{0, 0, from}, {0, 0, to}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    box.low[axis] = least[axis] - std::min<std::size_t>(least[axis], 1);
    box.high[axis] = std::min(mask.size[axis], greatest[axis] + 2);
  }
  return box;
}

Grid<std::uint8_t> part_of(const Grid<std::uint8_t>& mask, const Box& box) {
  Grid<std::uint8_t> part{{}, mask.factor, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) part.size[axis] = box.high[axis] - box.low[axis];
  for (std::size_t k = box.low[2]; k < box.high[2]; ++k)
    for (std::size_t j = box.low[1]; j < box.high[1]; ++j) {
      const auto row = mask.values.begin() + static_cast<std::ptrdiff_t>(mask.index(box.low[0], j, k));
      part.values.insert(part.values.end(), row, row + static_cast<std::ptrdiff_t>(part.size[0]));
    }
  return part;
}

/// A node of the mask and its distance to the mask's surface, in nodes.
struct Summit {
  float distance;
  std::size_t node;
};

/// Nodes of slices [first, last) that no neighbour among 26 exceeds, with a distance above `least`; of equal
/// neighbours the first.
std::vector<Summit> summits(const Grid<float>& distance, std::size_t first, std::size_t last, double least) {
  const auto& size = distance.size;
  const auto highest = [&](std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t n = distance.index(i, j, k);
    const float own = distance.values[n];
    for (std::size_t c = k ? k - 1 : 0; c < std::min(size[2], k + 2); ++c)
      for (std::size_t b = j ? j - 1 : 0; b < std::min(size[1], j + 2); ++b)
        for (std::size_t a = i ? i - 1 : 0; a < std::min(size[0], i + 2); ++a) {
          const std::size_t m = distance.index(a, b, c);
          if (distance.values[m] > own || (distance.values[m] == own && m < n)) return false;
        }
    return true;
  };
  std::vector<Summit> found;
  for (std::size_t k = first; k < last; ++k)
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i)
        if (const std::size_t n = distance.index(i, j, k); distance.values[n] > least && highest(i, j, k))
          found.push_back({distance.values[n], n});
  return found;
}

/// Summits of slices [first, last) of the mask. The map is made of these slices and so many around them that
/// no surface beyond could be nearer.
std::vector<Summit> summits_between(const Grid<std::uint8_t>& mask, std::size_t first, std::size_t last,
                                    double least) {
  for (std::size_t margin = 16;; margin *= 2) {
    const std::size_t from = first - std::min(first, margin), to = std::min(mask.size[2], last + margin);
    const auto box = occupied(mask, from, to);
    if (!box) return {};
    const Grid<float> distance = distance_inside(part_of(mask, *box));
    const std::size_t slice = distance.size[0] * distance.size[1];
    const auto core = distance.values.begin() + static_cast<std::ptrdiff_t>((first - from) * slice);
    const float greatest =
        *std::max_element(core, core + static_cast<std::ptrdiff_t>((last - first) * slice));
    if (greatest > static_cast<float>(margin - 2) && (from > 0 || to < mask.size[2])) continue;
    auto found = summits(distance, first - from, last - from, least);
    for (Summit& summit : found) {
      const std::size_t i = summit.node % distance.size[0],
                        j = summit.node / distance.size[0] % distance.size[1], k = summit.node / slice;
      summit.node = mask.index(box->low[0] + i, box->low[1] + j, from + k);
    }
    return found;
  }
}

/// From the highest down.
std::vector<Summit> all_summits(const Grid<std::uint8_t>& mask, double least) {
  constexpr std::size_t thickness = 48;
  std::vector<std::vector<Summit>> found((mask.size[2] + thickness - 1) / thickness);
  for_blocks(mask.size[2], thickness, [&](std::size_t first, std::size_t last) {
    found[first / thickness] = summits_between(mask, first, last, least);
  });
  std::vector<Summit> all;
  for (const auto& slab : found) all.insert(all.end(), slab.begin(), slab.end());
  std::sort(all.begin(), all.end(), [](const Summit& a, const Summit& b) {
    return std::make_tuple(-a.distance, a.node) < std::make_tuple(-b.distance, b.node);
  });
  return all;
}

/// Accepted seeds by cells as wide as the largest ball, so that a candidate looks at 27 cells only.
class SeedCells {
 public:
  explicit SeedCells(double width) : width_(width) {}

  void add(const Seed& seed) { cells_[key(cell(seed.centre))].push_back(seed); }

  bool rejects(const Seed& candidate) const {
    const auto own = cell(candidate.centre);
    for (long c = -1; c <= 1; ++c)
      for (long b = -1; b <= 1; ++b)
        for (long a = -1; a <= 1; ++a) {
          const auto found = cells_.find(key({own[0] + a, own[1] + b, own[2] + c}));
          if (found == cells_.end()) continue;
          for (const Seed& seed : found->second)
            if ((seed.centre - candidate.centre).norm() < seed.radius + 0.5 * candidate.radius) return true;
        }
    return false;
  }

 private:
  using Cell = std::array<long, 3>;
  Cell cell(const Vec3& p) const {
    return {static_cast<long>(std::floor(p.x() / width_)), static_cast<long>(std::floor(p.y() / width_)),
            static_cast<long>(std::floor(p.z() / width_))};
  }
  static long key(const Cell& cell) { return (cell[2] * 2097152 + cell[1]) * 2097152 + cell[0]; }

  double width_;
  std::unordered_map<long, std::vector<Seed>> cells_;
};

}  // namespace

std::vector<Seed> find_seeds(const Grid<std::uint8_t>& mask, double least_radius) {
  const double factor = static_cast<double>(mask.factor);
  const auto candidates = all_summits(mask, least_radius / factor);
  std::vector<Seed> seeds;
  if (candidates.empty()) return seeds;
  SeedCells accepted(1.5 * factor * candidates.front().distance);
  for (const auto& [distance, n] : candidates) {
    const std::size_t i = n % mask.size[0], j = n / mask.size[0] % mask.size[1],
                      k = n / (mask.size[0] * mask.size[1]);
    const Seed seed{mask.at(i, j, k), factor * distance};
    if (accepted.rejects(seed)) continue;
    accepted.add(seed);
    seeds.push_back(seed);
  }
  return seeds;
}

double typical_radius(const std::vector<Seed>& seeds) {
  if (seeds.empty()) return 0.0;
  std::vector<double> radii;
  double total = 0.0;
  for (const Seed& seed : seeds) {
    radii.push_back(seed.radius);
    total += std::pow(seed.radius, 3);
  }
  std::sort(radii.begin(), radii.end());
  double sum = 0.0;
  for (const double radius : radii)
    if ((sum += std::pow(radius, 3)) >= 0.5 * total) return radius;
  return radii.back();
}

}  // namespace pendular
