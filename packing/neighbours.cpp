#include "packing/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/parallel.h"

namespace pendular {
namespace {

/// A grid of cubic cells no smaller than `reach`, so that all within reach of a point lie in its 27 cells.
class CellGrid {
 public:
  CellGrid(std::span<const Vec3> points, double reach) {
    Vec3 highest = points.front();
    lowest_ = points.front();
    for (const auto& point : points) {
      lowest_ = lowest_.cwiseMin(point);
      highest = highest.cwiseMax(point);
    }
    set_cells(highest - lowest_, reach, points.size());
    first_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
    std::vector<std::size_t> cell(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      cell[k] = index(at(points[k]));
      ++first_[cell[k] + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    members_.resize(points.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t k = 0; k < points.size(); ++k) members_[next[cell[k]]++] = static_cast<int>(k);
  }

  /// Calls visit(j) for every point in the 27 cells around `point`.
  template <typename Visit>
  void around(const Vec3& point, const Visit& visit) const {
    const Cell centre = at(point);
    Cell from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = centre[axis] == 0 ? 0 : centre[axis] - 1;
      to[axis] = std::min(centre[axis] + 1, count_[axis] - 1);
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z)
      for (std::size_t y = from[1]; y <= to[1]; ++y) {
        // Cells along x lie next to each other, so do their members.
        const std::size_t begin = first_[index({from[0], y, z})], end = first_[index({to[0], y, z}) + 1];
        for (std::size_t m = begin; m < end; ++m) visit(members_[m]);
      }
  }

 private:
  using Cell = std::array<std::size_t, 3>;

  /// Cells grow beyond `reach` where the points are few in a wide space, to keep the grid's memory linear.
  void set_cells(const Vec3& extent, double reach, std::size_t points) {
    const double most_cells = 8.0 * static_cast<double>(points) + 64.0;
    size_ = reach;
    auto cells = [&] { return ((extent / size_).array().floor() + 1.0).prod(); };
    while (cells() > most_cells) size_ *= 1.3;
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<std::size_t>(extent[axis] / size_) + 1;
  }

  Cell at(const Vec3& point) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] =
          std::min(static_cast<std::size_t>((point[axis] - lowest_[axis]) / size_), count_[axis] - 1);
    return cell;
  }
  std::size_t index(const Cell& cell) const { return (cell[2] * count_[1] + cell[1]) * count_[0] + cell[0]; }

  Vec3 lowest_;
  double size_ = 0.0;
  Cell count_{};
  std::vector<std::size_t> first_;
  std::vector<int> members_;
};

}  // namespace

std::vector<IndexPair> pairs_within(std::span<const Vec3> centres, std::span<const double> diameters,
                                    double max_gap) {
  if (centres.empty()) return {};
  const double reach = *std::max_element(diameters.begin(), diameters.end()) + max_gap;
  if (!(reach > 0.0)) return {};
  const CellGrid grid(centres, reach);

  constexpr std::size_t kBlock = 256;
  std::vector<std::vector<IndexPair>> found((centres.size() + kBlock - 1) / kBlock);
  for_blocks(centres.size(), kBlock, [&](std::size_t first, std::size_t last) {
    auto& pairs = found[first / kBlock];
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t begin = pairs.size();
      grid.around(centres[i], [&](int j) {
        if (static_cast<std::size_t>(j) <= i) return;
        const double separation = (centres[i] - centres[j]).norm() - 0.5 * (diameters[i] + diameters[j]);
        if (separation < max_gap) pairs.emplace_back(static_cast<int>(i), j);
      });
      std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.end());
    }
  });

  std::vector<IndexPair> all;
  for (const auto& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
  return all;
}

}  // namespace pendular
