#include "segmentation/image_defects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/quantile.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

/// Of some rows of a slice.
struct Slice {
  double mean = 0.0, spread = 0.0;
  double change = 0.0;  ///< mean of the absolute difference from the slice before
};

template <typename T>
Slice slice_of(std::span<const Grey<T>> pixels, const Volume& volume, std::size_t k) {
  constexpr std::size_t step = 8;
  double n = 0.0, sum = 0.0, squares = 0.0, change = 0.0;
  for (std::size_t j = 0; j < volume.size[1]; j += step) {
    const std::size_t first = (k * volume.size[1] + j) * volume.size[0];
    const auto row = pixels.subspan(first, volume.size[0]);
    const auto before = k ? pixels.subspan(first - volume.size[0] * volume.size[1], volume.size[0]) : row;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double grey = static_cast<double>(row[i]);
      n += 1.0, sum += grey, squares += grey * grey;
      change += std::abs(grey - static_cast<double>(before[i]));
    }
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean)), change / n};
}

/// "slice 3", "slices 3 to 7, 9 and 11"; the first ten ranges.
std::string named(const std::vector<std::size_t>& slices) {
  std::vector<std::string> ranges;
  for (std::size_t n = 0; n < slices.size();) {
    std::size_t last = n;
    while (last + 1 < slices.size() && slices[last + 1] == slices[last] + 1) ++last;
    ranges.push_back(last == n ? fmt::format("{}", slices[n])
                               : fmt::format("{} to {}", slices[n], slices[last]));
    n = last + 1;
  }
  constexpr std::size_t most = 10;
  const bool more = ranges.size() > most;
  ranges.resize(std::min(most, ranges.size()));
  return fmt::format("slice{} {}{}", slices.size() == 1 ? "" : "s", fmt::join(ranges, ", "),
                     more ? " and others" : "");
}

/// Whether slice k does not follow from the one before: it differs from it far more than slices about them
/// do, and neither does so, as they would at the blurred face of a piston; and what is before and after it is
/// alike.
bool breaks(const std::vector<Slice>& slices, std::size_t k) {
  constexpr std::size_t reach = 10, near = 2;
  if (k < near + 1 || k + near + 1 > slices.size()) return false;
  std::vector<double> about;
  for (std::size_t n = std::max<std::size_t>(k, reach + 1) - reach; n < std::min(slices.size(), k + reach);
       ++n)
    if (n + 1 < k || n > k + 1) about.push_back(slices[n].change);
  const double usual = median(about), rise = slices[k].change - usual;
  const double beside = std::max(slices[k - 1].change, slices[k + 1].change) - usual;
  const Slice &before = slices[k - near], &after = slices[k + near];
  return usual > 0.0 && slices[k].change > kThresholds.slice_rise * usual &&
         rise > kThresholds.slice_over_next * beside &&
         std::abs(after.mean - before.mean) < kThresholds.slice_alike * before.spread &&
         std::abs(after.spread - before.spread) < kThresholds.slice_alike * before.spread;
}

void add_slice_defects(const Volume& volume, std::size_t first_slice, std::vector<std::string>& defects) {
  std::vector<Slice> slices(volume.size[2]);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(slices.size(), 1,
               [&](std::size_t k, std::size_t) { slices[k] = slice_of(pixels, volume, k); });
  });
  std::vector<std::size_t> even, repeated, broken;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    if (slices[k].spread == 0.0)
      even.push_back(first_slice + k);
    else if (k && slices[k].change == 0.0)
      repeated.push_back(first_slice + k);
    else if (breaks(slices, k))
      broken.push_back(first_slice + k);
  }
  if (!even.empty()) defects.push_back(fmt::format("{}, from 0 on: one grey value throughout", named(even)));
  if (!repeated.empty())
    defects.push_back(fmt::format("{}, from 0 on: the same as the one before", named(repeated)));
  if (!broken.empty())
    defects.push_back(fmt::format(
        "{}, from 0 on: not a continuation of the one before; slices missing, or a moved specimen?",
        named(broken)));
}

/// Many voxels at the very end of the grey values, and few just within.
void add_clipping(const Histogram& histogram, bool greatest, std::vector<std::string>& defects) {
  constexpr double width = 64.0;
  const auto occupied = [](double count) { return count > 0.0; };
  const auto& counts = histogram.counts;
  const auto low = std::find_if(counts.begin(), counts.end(), occupied) - counts.begin();
  const auto high = counts.rend() - std::find_if(counts.rbegin(), counts.rend(), occupied) - 1;
  const auto next = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>((high - low) / width));
  if (high - low <= next) return;
  const auto end = greatest ? high : low;
  const auto first = counts.begin() + (greatest ? high - next : low + 1);
  const double within = std::accumulate(first, first + next, 0.0) / static_cast<double>(next);
  const double count = counts[static_cast<std::size_t>(end)];
  const double share = count / std::accumulate(counts.begin(), counts.end(), 0.0);
  if (share < kThresholds.end_share || count < kThresholds.end_over_next * within) return;
  defects.push_back(fmt::format(
      "{:.1f} % of the voxels have the {} grey value, {:.6g}: if grey values were cut off there, diameters "
      "are wrong",
      100.0 * share, greatest ? "greatest" : "least", histogram.centre(static_cast<std::size_t>(end))));
}

}  // namespace

std::vector<std::string> image_defects(const Volume& volume, const Histogram& histogram,
                                       std::size_t first_slice) {
  std::vector<std::string> defects;
  for (const bool greatest : {false, true}) add_clipping(histogram, greatest, defects);
  add_slice_defects(volume, first_slice, defects);
  release(volume);
  return defects;
}

}  // namespace pendular::segmentation
