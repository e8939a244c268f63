#include "segmentation/search/grey_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <type_traits>

#include "base/parallel.h"

namespace pendular::segmentation {
namespace {

constexpr std::size_t most_bins = 65536;

template <typename T>
std::pair<T, T> extremes(std::span<const Grey<T>> values) {
  if constexpr (sizeof(T) <= sizeof(std::uint16_t))
    return {std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
  std::mutex guard;
  T least = values[0], greatest = values[0];
  for_blocks(values.size(), 1 << 22, [&](std::size_t first, std::size_t last) {
    T low = values[first], high = low;
    for (std::size_t k = first; k < last; ++k) {
      const T value = values[k];
      low = value < low ? value : low;
      high = value > high ? value : high;
    }
    const std::lock_guard lock(guard);
    least = std::min(least, low);
    greatest = std::max(greatest, high);
  });
  return {least, greatest};
}

/// The same grey values in at most `bins` bins between the 0.05 % and 99.95 % quantiles, where rare extremes
/// (metal, dead detector pixels) have no weight.
Histogram coarsened(const Histogram& fine, std::size_t bins) {
  const double total = std::accumulate(fine.counts.begin(), fine.counts.end(), 0.0);
  constexpr double tail = 5e-4;
  std::size_t low = 0, high = fine.counts.size() - 1;
  for (double sum = fine.counts[low]; sum <= tail * total && low < high;) sum += fine.counts[++low];
  for (double sum = fine.counts[high]; sum <= tail * total && high > low;) sum += fine.counts[--high];
  const std::size_t merged = std::max<std::size_t>(1, (high - low + bins) / bins);
  Histogram coarse{
      fine.lowest + static_cast<double>(low) * fine.width, fine.width * static_cast<double>(merged), {}};
  coarse.counts.assign((high - low) / merged + 1, 0.0);
  for (std::size_t k = low; k <= high; ++k) coarse.counts[(k - low) / merged] += fine.counts[k];
  return coarse;
}

/// The last bin of the darker class.
std::size_t otsu_bin(const Histogram& histogram) {
  double total = 0.0, total_sum = 0.0;
  for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
    total += histogram.counts[k];
    total_sum += histogram.counts[k] * histogram.centre(k);
  }
  double weight = 0.0, sum = 0.0, best = -1.0;
  std::size_t bin = 0;
  for (std::size_t k = 0; k + 1 < histogram.counts.size(); ++k) {
    weight += histogram.counts[k];
    sum += histogram.counts[k] * histogram.centre(k);
    if (weight == 0.0 || weight == total) continue;
    const double difference = sum / weight - (total_sum - sum) / (total - weight);
    const double between = weight * (total - weight) * difference * difference;
    if (between > best) {
      best = between;
      bin = k;
    }
  }
  return bin;
}

/// Counts convolved with a Gaussian of `sd` bins.
std::vector<double> smoothed(const std::vector<double>& counts, double sd) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3.0 * sd));
  std::vector<double> result(counts.size(), 0.0);
  for (std::ptrdiff_t bin = 0; bin < std::ssize(counts); ++bin)
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, bin - reach);
         k <= std::min(bin + reach, std::ssize(counts) - 1); ++k)
      result[static_cast<std::size_t>(bin)] +=
          counts[static_cast<std::size_t>(k)] *
          std::exp(-0.5 * static_cast<double>((k - bin) * (k - bin)) / (sd * sd));
  return result;
}

/// The highest maximum of the counts within bins [first, last), refined by a parabola; none where they only
/// rise or fall across the class. The ends of the whole histogram count as lower.
std::optional<double> peak(const Histogram& histogram, const std::vector<double>& counts, std::size_t first,
                           std::size_t last) {
  const auto at = [&](std::ptrdiff_t k) {
    return k < 0 || k >= std::ssize(counts) ? 0.0 : counts[static_cast<std::size_t>(k)];
  };
  std::optional<std::size_t> best;
  for (std::size_t k = first; k < last; ++k) {
    const auto n = static_cast<std::ptrdiff_t>(k);
    if (at(n) > at(n - 1) && at(n) >= at(n + 1) && (!best || counts[k] > counts[*best])) best = k;
  }
  if (!best) return std::nullopt;
  const auto n = static_cast<std::ptrdiff_t>(*best);
  const double curvature = at(n - 1) - 2.0 * at(n) + at(n + 1);
  const double shift =
      curvature < 0.0 ? std::clamp(0.5 * (at(n - 1) - at(n + 1)) / curvature, -0.5, 0.5) : 0.0;
  return histogram.centre(*best) + shift * histogram.width;
}

double mean(const Histogram& histogram, std::size_t first, std::size_t last) {
  double weight = 0.0, sum = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    weight += histogram.counts[k];
    sum += histogram.counts[k] * histogram.centre(k);
  }
  return weight > 0.0 ? sum / weight : histogram.centre(first);
}

template <typename T>
Histogram counted(std::span<const Grey<T>> values) {
  const auto [least, greatest] = extremes(values);
  const double range = static_cast<double>(greatest) - static_cast<double>(least);
  const bool exact = std::is_integral_v<T> && range < static_cast<double>(most_bins);
  Histogram histogram;
  histogram.width = exact ? 1.0 : range / static_cast<double>(most_bins - 1);
  histogram.lowest = static_cast<double>(least) - 0.5 * histogram.width;
  const std::size_t bins = exact ? static_cast<std::size_t>(range) + 1 : most_bins;
  std::vector<std::uint64_t> counts(bins, 0);
  std::mutex guard;
  const double lowest = histogram.lowest, per_bin = 1.0 / histogram.width;
  for_blocks(values.size(), 1 << 24, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> own(bins, 0);
    for (std::size_t k = first; k < last; ++k)
      ++own[std::min(bins - 1,
                     static_cast<std::size_t>((static_cast<double>(values[k]) - lowest) * per_bin))];
    const std::lock_guard lock(guard);
    for (std::size_t k = 0; k < bins; ++k) counts[k] += own[k];
  });
  histogram.counts.assign(counts.begin(), counts.end());
  return histogram;
}

}  // namespace

Histogram histogram_of(std::span<const float> values) {
  return counted(std::span(reinterpret_cast<const Grey<float>*>(values.data()), values.size()));
}

Histogram histogram_of(const Volume& volume) {
  return with_pixels(volume, [](auto pixels) { return counted(pixels); });
}

GreyLevels grey_levels(const Histogram& histogram) {
  const Histogram coarse = coarsened(histogram, 512);
  const std::size_t split = otsu_bin(coarse);
  const std::size_t bins = coarse.counts.size();
  const double sd = std::max(0.5, static_cast<double>(bins) / 100.0);
  const auto counts = smoothed(coarse.counts, sd);
  const auto dark = peak(coarse, counts, 0, split + 1), bright = peak(coarse, counts, split + 1, bins);
  GreyLevels levels;
  levels.dark = dark && bright ? *dark : mean(coarse, 0, split + 1);
  levels.bright = dark && bright ? *bright : mean(coarse, split + 1, bins);
  levels.threshold = 0.5 * (levels.dark + levels.bright);
  return levels;
}

}  // namespace pendular::segmentation
