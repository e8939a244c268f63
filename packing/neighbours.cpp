#include "packing/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/buckets.h"
#include "base/parallel.h"

namespace pendular {
namespace {

/// Points sorted by the cubic cells of a grid, cells along x next to each other.
class CellGrid {
 public:
  struct Member {
    Vec3 centre;
    double diameter;
    int point;
  };

  /// Cells are as large as `size`, or larger.
  CellGrid(std::span<const Vec3> centres, std::span<const double> diameters, double size) {
    Vec3 highest = centres.front();
    lowest_ = centres.front();
    for (const auto& centre : centres) {
      lowest_ = lowest_.cwiseMin(centre);
      highest = highest.cwiseMax(centre);
    }
    set_cells(highest - lowest_, size, centres.size());
    std::vector<std::size_t> cell(centres.size());
    for (std::size_t k = 0; k < centres.size(); ++k) cell[k] = index(at(centres[k]));
    Buckets sorted = sort_by_number(cell, count_[0] * count_[1] * count_[2]);
    first_ = std::move(sorted.first);
    members_.reserve(centres.size());
    for (const std::size_t k : sorted.items)
      members_.push_back({centres[k], diameters[k], static_cast<int>(k)});
  }

  std::span<const Member> members() const { return members_; }

  /// Calls visit(members) for all members of the cells that a cube reaches from `centre`, row by row.
  template <typename Visit>
  void around(const Vec3& centre, double reach, const Visit& visit) const {
    const Vec3 half = Vec3::Constant((1.0 + 1e-6) * reach);  // more than what rounding takes
    const Cell from = at(centre - half), to = at(centre + half);
    for (std::size_t z = from[2]; z <= to[2]; ++z)
      for (std::size_t y = from[1]; y <= to[1]; ++y) {
        const std::size_t begin = first_[index({from[0], y, z})], end = first_[index({to[0], y, z}) + 1];
        visit(members().subspan(begin, end - begin));
      }
  }

 private:
  using Cell = std::array<std::size_t, 3>;

  /// Cells grow where the points are few in a wide space, to keep the grid's memory linear.
  void set_cells(const Vec3& extent, double size, std::size_t points) {
    const double most_cells = 8.0 * static_cast<double>(points) + 64.0;
    size_ = size;
    auto cells = [&] { return ((extent / size_).array().floor() + 1.0).prod(); };
    while (cells() > most_cells) size_ *= 1.3;
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<std::size_t>(extent[axis] / size_) + 1;
  }

  /// The cell of a place, or the nearest one.
  Cell at(const Vec3& place) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = (place[axis] - lowest_[axis]) / size_;
      cell[axis] =
          cells > 0.0 ? static_cast<std::size_t>(std::min(cells, static_cast<double>(count_[axis] - 1))) : 0;
    }
    return cell;
  }
  std::size_t index(const Cell& cell) const { return (cell[2] * count_[1] + cell[1]) * count_[0] + cell[0]; }

  Vec3 lowest_;
  double size_ = 0.0;
  Cell count_{};
  std::vector<std::size_t> first_;
  std::vector<Member> members_;
};

constexpr std::size_t kMembersPerTask = 256;

/// Pairs, each found from the larger of its two spheres, so that a few large ones do not widen the search of
/// all.
std::vector<IndexPair> find_pairs(const CellGrid& grid, double max_gap) {
  const auto members = grid.members();
  std::vector<std::vector<IndexPair>> found((members.size() + kMembersPerTask - 1) / kMembersPerTask);
  for_blocks(members.size(), kMembersPerTask, [&](std::size_t first, std::size_t last) {
    auto& pairs = found[first / kMembersPerTask];
    std::size_t size = 0;
    for (std::size_t m = first; m < last; ++m) {
      const CellGrid::Member& own = members[m];
      const double reach = own.diameter + max_gap;
      if (!(reach > 0.0)) continue;
      grid.around(own.centre, reach, [&](std::span<const CellGrid::Member> row) {
        if (size + row.size() > pairs.size()) pairs.resize(2 * (size + row.size()));
        // Every pair is written and kept or not: whether it is near cannot be guessed.
        for (const auto& other : row) {
          const bool smaller = (other.diameter < own.diameter) |
                               ((other.diameter == own.diameter) & (other.point > own.point));
          const double separation =
              (own.centre - other.centre).norm() - 0.5 * (own.diameter + other.diameter);
          pairs[size] = std::minmax(own.point, other.point);
          size += static_cast<std::size_t>(smaller & (separation < max_gap));
        }
      });
    }
    pairs.resize(size);
  });
  std::vector<IndexPair> all;
  for (const auto& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
  return all;
}

/// Sorted by the first point, then among those of one.
std::vector<IndexPair> sorted(const std::vector<IndexPair>& pairs, std::size_t points) {
  std::vector<std::size_t> first_point;
  first_point.reserve(pairs.size());
  for (const auto& pair : pairs) first_point.push_back(static_cast<std::size_t>(pair.first));
  const auto [first, items] = sort_by_number(first_point, points);
  std::vector<IndexPair> all;
  all.reserve(pairs.size());
  for (const std::size_t k : items) all.push_back(pairs[k]);
  for (std::size_t k = 0; k < points; ++k)
    std::sort(all.begin() + static_cast<std::ptrdiff_t>(first[k]),
              all.begin() + static_cast<std::ptrdiff_t>(first[k + 1]));
  return all;
}

}  // namespace

std::vector<IndexPair> pairs_within(std::span<const Vec3> centres, std::span<const double> diameters,
                                    double max_gap) {
  if (centres.empty()) return {};
  if (!(*std::max_element(diameters.begin(), diameters.end()) + max_gap > 0.0)) return {};
  double mean = 0.0;
  for (const double diameter : diameters)
    mean += std::max(diameter + max_gap, 0.0) / static_cast<double>(diameters.size());
  return sorted(find_pairs(CellGrid(centres, diameters, 0.5 * mean), max_gap), centres.size());
}

}  // namespace pendular
