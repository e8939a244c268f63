#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace pendular {

/// Items sorted by whole numbers: those of number k, in their own order, are items[first[k]] up to
/// items[first[k + 1]].
struct Buckets {
  std::vector<std::size_t> first, items;
};

/// Sorts 0, 1, … by their numbers, each below `count`. Linear time.
inline Buckets sort_by_number(std::span<const std::size_t> number, std::size_t count) {
  Buckets sorted{std::vector<std::size_t>(count + 1, 0), std::vector<std::size_t>(number.size())};
  for (const std::size_t one : number) ++sorted.first[one + 1];
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  std::vector<std::size_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (std::size_t k = 0; k < number.size(); ++k) sorted.items[next[number[k]]++] = k;
  return sorted;
}

}  // namespace pendular
