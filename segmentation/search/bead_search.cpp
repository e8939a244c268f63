#include "segmentation/search/bead_search.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "segmentation/search/field_of_view.h"
#include "segmentation/search/padding.h"
#include "segmentation/thresholds.h"
#include "volume/resample.h"

namespace pendular::segmentation {
namespace {

Grid<std::uint8_t> mask_of(const Grid<float>& grey, double threshold, bool bright) {
  Grid<std::uint8_t> mask{grey.size, grey.factor, std::vector<std::uint8_t>(grey.values.size())};
  for_blocks(grey.values.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) mask.values[n] = (grey.values[n] > threshold) == bright;
  });
  return mask;
}

/// Of the voxels within the container, where neither its walls nor the air around it count; of some millions
/// of them, on every so many rows and slices.
GreyLevels levels_within(const Volume& volume, const Container& container) {
  constexpr double enough = 8e6;
  const auto step = static_cast<std::size_t>(
      std::ceil(std::sqrt(std::max(1.0, static_cast<double>(volume.voxels()) / enough))));
  std::vector<float> values;
  with_pixels(volume, [&](auto pixels) {
    for (std::size_t k = 0; k < volume.size[2]; k += step)
      for (std::size_t j = 0; j < volume.size[1]; j += step)
        for (std::size_t i = 0; i < volume.size[0]; ++i)
          if (within(container, Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))))
            values.push_back(static_cast<float>(pixels[(k * volume.size[1] + j) * volume.size[0] + i]));
  });
  return grey_levels(histogram_of(std::span<const float>(values)));
}

/// Mask and seeds from the grey values; levels, tone and container are known.
void find_bodies(BeadSearch& search, const Grid<float>& smooth) {
  search.mask = mask_of(smooth, search.levels.threshold, search.bright);
  if (search.container) clear_outside(search.mask, *search.container);
  search.seeds = find_seeds(search.mask, 1.5 * smooth.factor);
  stop_if_interrupted();
}

/// Volume of the balls inscribed at the seeds over that of the mask: near one for balls, less for what lies
/// between them. Bodies that the picture cuts do not count: they may be of any shape.
double inscribed_share(const BeadSearch& search) {
  const auto& mask = search.mask;
  const double factor = mask.factor;
  const auto whole = [&](const Seed& seed) {
    for (int axis = 0; axis < 3; ++axis) {
      const double last = factor * static_cast<double>(mask.size[static_cast<std::size_t>(axis)]) - 1.0;
      if (seed.centre[axis] < seed.radius || seed.centre[axis] > last - seed.radius) return false;
    }
    return true;
  };
  double balls = 0.0, nodes = 0.0;
  for (const Seed& seed : search.seeds)
    if (whole(seed)) balls += 4.0 / 3.0 * M_PI * std::pow(seed.radius, 3);
  for (const std::uint8_t m : mask.values) nodes += m;
  return nodes > 0.0 ? balls / (nodes * std::pow(factor, 3)) : 0.0;
}

/// The smallest power of two, from two on, that leaves at most 2²⁸ nodes.
std::size_t first_factor(const Volume& volume) {
  constexpr std::size_t most_nodes = std::size_t{1} << 28;
  std::size_t factor = 2;
  while (volume.voxels() / (factor * factor * factor) > most_nodes) factor *= 2;
  return factor;
}

/// A box of a grid, and the voxel at which it begins.
struct Part {
  Grid<float> grey;
  Vec3 first = Vec3::Zero();
};

/// Where boxes of `edge` nodes begin that cover an axis of `size` nodes and overlap by half.
std::vector<std::size_t> box_starts(std::size_t size, std::size_t edge) {
  std::vector<std::size_t> starts;
  for (std::size_t n = 0; n + edge < size; n += edge / 2) starts.push_back(n);
  starts.push_back(size - std::min(size, edge));
  return starts;
}

/// Of a box's nodes, some thousands looked at.
double variance_within(const Grid<float>& grey, const Box& box) {
  constexpr std::size_t step = 8;
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t k = box.low[2]; k < box.high[2]; k += step)
    for (std::size_t j = box.low[1]; j < box.high[1]; j += step)
      for (std::size_t i = box.low[0]; i < box.high[0]; i += step) {
        const double value = grey.values[grey.index(i, j, k)];
        n += 1.0, sum += value, squares += value * value;
      }
  return squares / n - sum / n * (sum / n);
}

/// The box of at most 256³ nodes in which grey values vary most: where the beads are.
Part most_varied_part(const Grid<float>& grey) {
  constexpr std::size_t edge = 256;
  Box best;
  double greatest = -1.0;
  for (const std::size_t k : box_starts(grey.size[2], edge))
    for (const std::size_t j : box_starts(grey.size[1], edge))
      for (const std::size_t i : box_starts(grey.size[0], edge)) {
        Box box{{i, j, k}, {}};
        for (std::size_t axis = 0; axis < 3; ++axis)
          box.high[axis] = std::min(grey.size[axis], box.low[axis] + edge);
        if (const double variance = variance_within(grey, box); variance > greatest)
          best = box, greatest = variance;
      }
  Part part{part_of(grey, best), {}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    part.first[static_cast<Eigen::Index>(axis)] = static_cast<double>(best.low[axis]) * grey.factor;
  return part;
}

/// Of the bodies of a part: share of them, and of their volume.
double sphericity(BeadSearch trial, const Part& part, bool bright, const BallShare& balls_among) {
  const auto container = trial.container;
  if (container) {
    trial.container->axis_x -= part.first.x(), trial.container->axis_y -= part.first.y();
    for (auto* end : {&trial.container->bottom, &trial.container->top})
      if (*end) **end -= part.first.z();
  }
  trial.bright = bright;
  find_bodies(trial, part.grey);
  const double inscribed = inscribed_share(trial);
  for (Seed& seed : trial.seeds) seed.centre += part.first;
  trial.container = container;
  return inscribed * balls_among(trial);
}

/// Takes the tone, of those that may be, whose bodies are more spherical.
void choose_tone(BeadSearch& search, const Grid<float>& grey, const std::vector<bool>& tones,
                 const BallShare& balls_among) {
  const Part part = most_varied_part(grey);
  search.sphericity = -1.0;
  for (const bool bright : tones)
    if (const double found = sphericity(search, part, bright, balls_among); found > search.sphericity)
      search.sphericity = found, search.bright = bright;
}

/// Whether typical beads have enough nodes across.
bool well_resolved(const BeadSearch& search) {
  return typical_radius(search.seeds) >= kThresholds.well_resolved * search.mask.factor;
}

/// The search on the volume's own voxels at the finest; all bodies.
BeadSearch search_bodies(const Volume& volume, BeadTone tone, const BallShare& balls_among) {
  constexpr double smoothing = 0.7;
  BeadSearch search;
  const auto view = field_of_view(volume);
  search.histogram = histogram_of(volume);
  if (view)
    leave_out(search.histogram, *view);
  else
    leave_out_corners(search.histogram, volume);
  search.levels = grey_levels(search.histogram);
  search.bright = tone != BeadTone::dark;
  release(volume);
  stop_if_interrupted();
  for (std::size_t factor = first_factor(volume);; factor /= 2) {
    Grid<float> smooth = reduced(volume, factor, smoothing);
    if (view) fill_beyond(smooth, *view);
    release(volume);
    stop_if_interrupted();
    search.container = find_container(smooth);
    if (search.container) search.levels = levels_within(volume, *search.container);
    const bool open = tone == BeadTone::automatic && (factor > 1 || search.container);
    choose_tone(search, smooth, open ? std::vector{true, false} : std::vector{search.bright}, balls_among);
    find_bodies(search, smooth);
    if (factor == 1 || (well_resolved(search) && (mostly_spherical(search) || !may_refine(volume))))
      return search;
  }
}

/// A search on voxels half as long, every other one of them a voxel of the volume, in the volume's own
/// voxels.
BeadSearch halved(BeadSearch search) {
  for (Seed& seed : search.seeds) seed.centre *= 0.5, seed.radius *= 0.5;
  search.mask.factor *= 0.5, search.mask.first *= 0.5;
  if (auto& container = search.container) {
    container->axis_x *= 0.5, container->axis_y *= 0.5, container->radius *= 0.5;
    for (auto* end : {&container->bottom, &container->top})
      if (*end) **end *= 0.5;
  }
  return search;
}

}  // namespace

bool mostly_spherical(const BeadSearch& search) {
  return search.sphericity > kThresholds.least_sphericity;
}

bool may_refine(const Volume& volume) {
  return volume.voxels() <= std::size_t{1} << 26;
}

BeadSearch search_beads(const Volume& volume, BeadTone tone, std::optional<double> least_radius,
                        const BallShare& balls_among) {
  BeadSearch search = search_bodies(volume, tone, balls_among);
  if (may_refine(volume) && !(well_resolved(search) && mostly_spherical(search))) {
    BeadSearch finer = search_bodies(resampled(volume, {2.0, 2.0, 2.0}), tone,
                                     [&](const BeadSearch& tried) { return balls_among(halved(tried)); });
    finer.histogram = search.histogram;
    if (mostly_spherical(finer)) search = halved(std::move(finer));
  }
  search.least_radius =
      least_radius.value_or(kThresholds.least_relative_radius * typical_radius(search.seeds));
  std::erase_if(search.seeds, [&](const Seed& seed) { return seed.radius < search.least_radius; });
  return search;
}

std::vector<Seed> search_missed(const Grid<std::uint8_t>& mask, const std::vector<Seed>& found,
                                double least_radius) {
  Grid<std::uint8_t> rest = mask;
  const double factor = mask.factor;
  for (const Seed& seed : found) {
    const double radius = seed.radius + 0.5 * factor;
    std::array<long, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(0L, static_cast<long>(std::floor((seed.centre[axis] - radius) / factor)));
      high[axis] = std::min(static_cast<long>(mask.size[axis]) - 1,
                            static_cast<long>(std::ceil((seed.centre[axis] + radius) / factor)));
    }
    for (long k = low[2]; k <= high[2]; ++k)
      for (long j = low[1]; j <= high[1]; ++j)
        for (long i = low[0]; i <= high[0]; ++i) {
          const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j),
                            c = static_cast<std::size_t>(k);
          if ((mask.at(a, b, c) - seed.centre).squaredNorm() < radius * radius)
            rest.values[mask.index(a, b, c)] = 0;
        }
  }
  return find_seeds(rest, least_radius);
}

}  // namespace pendular::segmentation
