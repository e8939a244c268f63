#include "segmentation/polarity.h"

#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace pendular {
namespace {

struct Sums {
  double weighted = 0.0, weight = 0.0;
};

/// Adds node n: |∇g| κ = −(∇²g − nᵀHn), by central differences.
void add_node(const float* g, std::size_t n, std::size_t dx, std::size_t dy, std::size_t dz, double least, Sums& sums) {
  const double gx = 0.5 * (g[n + dx] - g[n - dx]), gy = 0.5 * (g[n + dy] - g[n - dy]), gz = 0.5 * (g[n + dz] - g[n - dz]);
  const double square = gx * gx + gy * gy + gz * gz;
  if (square < least * least) return;
  const auto second = [&](std::size_t d) { return double(g[n + d]) - 2.0 * g[n] + g[n - d]; };
  const auto mixed = [&](std::size_t a, std::size_t b) {
    return 0.25 * (double(g[n + a + b]) - g[n + a - b] - g[n - a + b] + g[n - a - b]);
  };
  const double xx = second(dx), yy = second(dy), zz = second(dz);
  const double along = gx * gx * xx + gy * gy * yy + gz * gz * zz +
                       2.0 * (gx * gy * mixed(dx, dy) + gx * gz * mixed(dx, dz) + gy * gz * mixed(dy, dz));
  sums.weighted -= xx + yy + zz - along / square;
  sums.weight += std::sqrt(square);
}

}  // namespace

double mean_edge_curvature(const Grid<float>& grey, const GreyLevels& levels) {
  const auto& size = grey.size;
  if (size[0] < 3 || size[1] < 3 || size[2] < 3) return 0.0;
  const double least = 0.15 * std::abs(levels.bright - levels.dark);
  std::vector<Sums> slices(size[2]);
  for_blocks(size[2] - 2, 1, [&](std::size_t slice, std::size_t) {
    const std::size_t k = slice + 1;
    for (std::size_t j = 1; j + 1 < size[1]; ++j)
      for (std::size_t i = 1; i + 1 < size[0]; ++i)
        add_node(grey.values.data(), grey.index(i, j, k), 1, size[0], size[0] * size[1], least, slices[k]);
  });
  Sums total;
  for (const Sums& slice : slices) {
    total.weighted += slice.weighted;
    total.weight += slice.weight;
  }
  return total.weight > 0.0 ? total.weighted / total.weight : 0.0;
}

}  // namespace pendular
