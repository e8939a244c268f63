#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace pendular {

/// The value at a place of the ordered values, 0 to n − 1.
template <typename T>
T ordered_value(std::vector<T> values, std::size_t place) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle one of some values, of an even number the upper one of the two in the middle; 0 of none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const std::size_t middle = values.size() / 2;
  return ordered_value(std::move(values), middle);
}

/// The one of some values below which a share of the others lies, rounded down: place ⌊share (n − 1)⌋ of the
/// ordered values, 0 ≤ share ≤ 1; 0 of none.
template <typename T>
T lower_quantile(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return ordered_value(std::move(values), place);
}

/// The lower_quantile() of each of some shares, which rise; as many zeros of no values.
template <typename T>
std::vector<T> lower_quantiles(std::vector<T> values, std::span<const double> shares) {
  std::vector<T> found;
  auto from = values.begin();  // what is before it is ordered in so far as it is less
  for (const double share : shares) {
    if (values.empty()) {
      found.push_back(T{});
      continue;
    }
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(from, at, values.end());
    found.push_back(*at);
    from = at;
  }
  return found;
}

/// Quantile by straight lines between the ordered values (Hyndman & Fan 1996, Am. Stat. 50, 361, type 7);
/// 0 ≤ share ≤ 1; NaN of none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto k = static_cast<std::size_t>(place);
  const double beyond = place - static_cast<double>(k);
  return beyond > 0.0 ? values[k] + beyond * (values[k + 1] - values[k]) : values[k];
}

}  // namespace pendular
