#include "segmentation/seeds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "base/parallel.h"

namespace pendular {
namespace {

/// Nodes that no neighbour among 26 exceeds, with a distance above `least` nodes; of equal neighbours the
/// first.
std::vector<std::size_t> maxima(const Grid<float>& distance, double least) {
  const auto& size = distance.size;
  std::vector<std::vector<std::size_t>> found(size[2]);
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
  for_blocks(size[2], 1, [&](std::size_t k, std::size_t) {
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i)
        if (const std::size_t n = distance.index(i, j, k); distance.values[n] > least && highest(i, j, k))
          found[k].push_back(n);
  });
  std::vector<std::size_t> all;
  for (const auto& slice : found) all.insert(all.end(), slice.begin(), slice.end());
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
  if (std::all_of(mask.values.begin(), mask.values.end(), [](std::uint8_t m) { return m == 0; })) return {};
  const Grid<float> distance = distance_inside(mask);
  const double factor = static_cast<double>(mask.factor);
  auto candidates = maxima(distance, least_radius / factor);
  std::sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return std::make_tuple(-distance.values[a], a) < std::make_tuple(-distance.values[b], b);
  });
  std::vector<Seed> seeds;
  if (candidates.empty()) return seeds;
  SeedCells accepted(1.5 * factor * distance.values[candidates.front()]);
  for (const std::size_t n : candidates) {
    const std::size_t i = n % mask.size[0], j = n / mask.size[0] % mask.size[1],
                      k = n / (mask.size[0] * mask.size[1]);
    const Seed seed{mask.at(i, j, k), factor * distance.values[n]};
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
