#include "segmentation/search/seeds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "base/parallel.h"
#include "segmentation/search/distance_map.h"
#include "segmentation/search/erosion.h"

namespace pendular::segmentation {
namespace {

/// What nodes of slices [from, to) whose ball of `radius` nodes may be within the mask take up: those with a
/// cube of the mask around them that such a ball holds. None if there is no such node.
std::optional<Box> roomy(const Grid<std::uint8_t>& mask, std::size_t from, std::size_t to, double radius) {
  const std::size_t nx = mask.size[0], ny = mask.size[1], nz = to - from;
  Grid<std::uint8_t> core = part_of(mask, {{0, 0, from}, {nx, ny, to}});
  erode(core, static_cast<std::size_t>(std::max(0.0, radius - 0.5) / std::sqrt(3.0)));
  Box box{{nx, ny, nz}, {0, 0, 0}};
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j) {
      const std::uint8_t* row = core.values.data() + core.index(0, j, k);
      const auto* first = static_cast<const std::uint8_t*>(std::memchr(row, 1, nx));
      if (!first) continue;
      const auto* last = static_cast<const std::uint8_t*>(::memrchr(row, 1, nx));
      box.low = {std::min<std::size_t>(box.low[0], first - row), std::min(box.low[1], j),
                 std::min(box.low[2], k)};
      box.high = {std::max<std::size_t>(box.high[0], last - row + 1), std::max(box.high[1], j + 1), k + 1};
    }
  if (box.high[2] == 0) return std::nullopt;
  box.low[2] += from, box.high[2] += from;
  return box;
}

/// With `margin` more nodes on all sides, as far as there are any.
Box widened(Box box, std::size_t margin, const std::array<std::size_t, 3>& size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= std::min(box.low[axis], margin);
    box.high[axis] = std::min(size[axis], box.high[axis] + margin);
  }
  return box;
}

/// A node of the mask and its distance to the mask's surface, in nodes.
struct Summit {
  float distance;
  std::size_t node;
};

/// Nodes of a part, within `core`, that no neighbour among 26 exceeds, with a distance above `least`; of
/// equal neighbours the first. Nodes are counted in the part.
std::vector<Summit> summits(const Grid<float>& distance, const Box& core, double least) {
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
  for (std::size_t k = core.low[2]; k < core.high[2]; ++k)
    for (std::size_t j = core.low[1]; j < core.high[1]; ++j)
      for (std::size_t i = core.low[0]; i < core.high[0]; ++i)
        if (const std::size_t n = distance.index(i, j, k); distance.values[n] > least && highest(i, j, k))
          found.push_back({distance.values[n], n});
  return found;
}

float greatest_within(const Grid<float>& distance, const Box& core) {
  float greatest = 0.0F;
  for (std::size_t k = core.low[2]; k < core.high[2]; ++k)
    for (std::size_t j = core.low[1]; j < core.high[1]; ++j)
      for (std::size_t i = core.low[0]; i < core.high[0]; ++i)
        greatest = std::max(greatest, distance.values[distance.index(i, j, k)]);
  return greatest;
}

/// Summits of slices [first, last) of the mask above `least` nodes. The map is made of where they may be and
/// of so much around it that no surface beyond could be nearer.
std::vector<Summit> summits_between(const Grid<std::uint8_t>& mask, std::size_t first, std::size_t last,
                                    double least) {
  const auto room = roomy(mask, first, last, least);
  if (!room) return {};
  constexpr std::size_t greatest_margin = 160;  // what is wider than this is no bead
  for (std::size_t margin : {std::size_t{16}, std::size_t{64}, greatest_margin}) {
    const Box box = widened(*room, margin, mask.size);
    const Grid<float> distance = distance_inside(part_of(mask, box));
    Box core = *room;
    for (std::size_t axis = 0; axis < 3; ++axis)
      core.low[axis] -= box.low[axis], core.high[axis] -= box.low[axis];
    const bool whole = box.low == std::array<std::size_t, 3>{} && box.high == mask.size;
    if (!whole && margin < greatest_margin &&
        greatest_within(distance, core) > static_cast<float>(margin - 2))
      continue;
    auto found = summits(distance, core, least);
    // Where no surface is, or none that the map knows to be the nearest, is no bead.
    constexpr float endless = std::numeric_limits<float>::max();
    const float known = whole ? endless : static_cast<float>(margin - 2);
    std::erase_if(found, [&](const Summit& one) { return one.distance > known || one.distance == endless; });
    for (Summit& summit : found)
      summit.node = mask.index(box.low[0] + summit.node % distance.size[0],
                               box.low[1] + summit.node / distance.size[0] % distance.size[1],
                               box.low[2] + summit.node / (distance.size[0] * distance.size[1]));
    return found;
  }
  return {};
}

/// From the highest down.
std::vector<Summit> all_summits(const Grid<std::uint8_t>& mask, double least) {
  constexpr std::size_t thickest = 96;
  const std::size_t slabs = (mask.size[2] + thickest - 1) / thickest;
  const std::size_t thickness = (mask.size[2] + slabs - 1) / std::max<std::size_t>(1, slabs);
  std::vector<std::vector<Summit>> found(slabs);
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
  const double factor = mask.factor;
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
  for (const double radius : radii) {
    sum += std::pow(radius, 3);
    if (sum >= 0.5 * total) return radius;
  }
  return radii.back();
}

}  // namespace pendular::segmentation
