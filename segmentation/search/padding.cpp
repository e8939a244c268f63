#include "segmentation/search/padding.h"

#include <algorithm>
#include <numeric>

#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

/// Extends the box by what differs in row (j, k) from the padding before it and after it.
template <typename T>
void extend(Box& box, std::span<const Grey<T>> row, T before, T after, std::size_t j, std::size_t k) {
  const auto first = std::find_if(row.begin(), row.end(), [&](T grey) { return grey != before; });
  const auto last = std::find_if(row.rbegin(), row.rend(), [&](T grey) { return grey != after; });
  if (first != row.end()) {
    box.low[0] = std::min(box.low[0], static_cast<std::size_t>(first - row.begin()));
    box.low[1] = std::min(box.low[1], j), box.low[2] = std::min(box.low[2], k);
  }
  if (last != row.rend()) {
    box.high[0] = std::max(box.high[0], static_cast<std::size_t>(row.rend() - last));
    box.high[1] = std::max(box.high[1], j + 1), box.high[2] = std::max(box.high[2], k + 1);
  }
}

/// Whether a volume's padding might have this value: hardly any voxel of the middle of the rest has it. Air
/// without noise, or cut off at the end of the grey values, is no padding.
bool may_pad(const Volume& volume, const Box& box, double value) {
  constexpr std::size_t step = 3;
  std::array<std::size_t, 3> low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t quarter = (box.high[axis] - box.low[axis]) / 4;
    low[axis] = box.low[axis] + quarter, high[axis] = box.high[axis] - quarter;
  }
  double n = 0.0, equal = 0.0;
  with_pixels(volume, [&](auto pixels) {
    for (std::size_t k = low[2]; k < high[2]; k += step)
      for (std::size_t j = low[1]; j < high[1]; j += step)
        for (std::size_t i = low[0]; i < high[0]; ++i) {
          const auto grey = pixels[(k * volume.size[1] + j) * volume.size[0] + i];
          n += 1.0, equal += static_cast<double>(grey) == value;
        }
  });
  return equal < kThresholds.padding_within * n;
}

/// Rows and slices from both ends inwards, so that a volume without padding is seen by its outer ones.
template <typename Visit>
void inwards(std::size_t size, Visit visit) {
  for (std::size_t n = 0; n < size; ++n) visit(n % 2 ? size - 1 - n / 2 : n / 2);
}

}  // namespace

Box without_padding(const Volume& volume) {
  const auto& size = volume.size;
  const Box whole{{}, size};
  Box box{size, {}};
  double first = 0.0, last = 0.0;
  with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    const T before = pixels.front(), after = pixels.back();
    first = static_cast<double>(before), last = static_cast<double>(after);
    inwards(size[2], [&](std::size_t k) {
      inwards(size[1], [&](std::size_t j) {
        if (box != whole)
          extend<T>(box, pixels.subspan((k * size[1] + j) * size[0], size[0]), before, after, j, k);
      });
    });
  });
  const bool padding = box != whole && may_pad(volume, box, first) && may_pad(volume, box, last);
  release(volume);
  return padding ? box : whole;
}

Volume part_of(const Volume& volume, const Box& box) {
  Volume part;
  part.spacing = volume.spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    part.size[axis] = box.high[axis] - box.low[axis];
    const auto n = static_cast<Eigen::Index>(axis);
    part.origin[n] = volume.origin[n] + volume.spacing * static_cast<double>(box.low[axis]);
  }
  const std::size_t slice = volume.size[0] * volume.size[1];
  const bool slices = part.size[0] == volume.size[0] && part.size[1] == volume.size[1];
  with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    std::vector<T> own;
    if (slices && volume.file) {
      part.file = volume.file, part.first_byte = volume.first_byte + sizeof(T) * slice * box.low[2];
    } else if (slices && volume.memory) {
      part.memory = {volume.memory, pixels.data() + slice * box.low[2]};
    } else {
      own.reserve(part.voxels());
      for (std::size_t k = box.low[2]; k < box.high[2]; ++k)
        for (std::size_t j = box.low[1]; j < box.high[1]; ++j) {
          const auto row = pixels.subspan(slice * k + volume.size[0] * j + box.low[0], part.size[0]);
          own.insert(own.end(), row.begin(), row.end());
        }
      release(volume);
    }
    part.pixels = std::move(own);
  });
  return part;
}

void leave_out_corners(Histogram& histogram, const Volume& volume) {
  const auto& size = volume.size;
  const auto corner = [&](std::size_t n) {
    const std::size_t i = n & 1 ? size[0] - 1 : 0, j = n & 2 ? size[1] - 1 : 0, k = n & 4 ? size[2] - 1 : 0;
    return with_pixels(
        volume, [&](auto pixels) { return static_cast<double>(pixels[(k * size[1] + j) * size[0] + i]); });
  };
  const double value = corner(0);
  for (std::size_t n = 1; n < 8; ++n)
    if (corner(n) != value) return;
  if (!may_pad(volume, {{}, size}, value)) return;
  auto& counts = histogram.counts;
  const double place = std::max(0.0, (value - histogram.lowest) / histogram.width);
  const auto bin = std::min(counts.size() - 1, static_cast<std::size_t>(place));
  constexpr std::size_t about = 32;
  const auto first = counts.begin() + static_cast<std::ptrdiff_t>(bin - std::min(bin, about));
  const auto last = counts.begin() + static_cast<std::ptrdiff_t>(std::min(counts.size(), bin + about + 1));
  const double beside = std::accumulate(first, last, -counts[bin]);
  counts[bin] = std::min(counts[bin], beside / static_cast<double>(last - first));
}

}  // namespace pendular::segmentation
