#include "segmentation/segment.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/quantile.h"
#include "packing/bridges.h"
#include "packing/statistics.h"
#include "segmentation/bridges/polymer_fit.h"
#include "segmentation/fit/bead_fit.h"
#include "segmentation/image_defects.h"
#include "segmentation/rows.h"
#include "segmentation/search/padding.h"
#include "segmentation/thresholds.h"
#include "volume/resample.h"

namespace pendular::segmentation {
namespace {

double quality_of(const BallFit& fit, const Noise& noise) {
  const double misfit_squared = std::max(0.0, fit.residual * fit.residual - noise.sd * noise.sd) /
                                (fit.ball.contrast * fit.ball.contrast);
  return 1.0 / (1.0 + misfit_squared / (kThresholds.half_quality * kThresholds.half_quality));
}

/// By rising z.
void sort_fits(std::vector<BallFit>& fits) {
  const auto place = [](const BallFit& fit) {
    return std::make_tuple(fit.ball.centre.z(), fit.ball.centre.y(), fit.ball.centre.x());
  };
  std::sort(fits.begin(), fits.end(),
            [&](const BallFit& a, const BallFit& b) { return place(a) < place(b); });
}

std::vector<Bead> beads_of(const Volume& volume, const FittedBeads& fitted) {
  std::vector<double> radii;
  for (const BallFit& fit : fitted.fits) radii.push_back(fit.ball.radius);
  const VarianceInflation inflation = variance_inflation(fitted.noise, median(radii), fitted.blur);
  std::vector<Bead> beads;
  for (const BallFit& fit : fitted.fits) {
    Bead bead;
    bead.id = static_cast<std::int64_t>(beads.size()) + 1;
    bead.centre = volume.origin + volume.spacing * fit.ball.centre;
    bead.diameter = 2.0 * volume.spacing * fit.ball.radius;
    bead.sigma_centre = volume.spacing * fit.sigma_centre * std::sqrt(inflation.centre);
    bead.sigma_diameter = 2.0 * volume.spacing * fit.sigma_radius * std::sqrt(inflation.radius);
    bead.quality = quality_of(fit, fitted.noise);
    beads.push_back(bead);
  }
  return beads;
}

std::vector<Bead> grains_of(const Volume& volume, const FittedBeads& fitted) {
  std::vector<Bead> grains;
  for (const Seed& seed : fitted.grains) {
    Bead grain;
    grain.id = static_cast<std::int64_t>(fitted.fits.size() + grains.size()) + 1;
    grain.centre = volume.origin + volume.spacing * seed.centre;
    grain.diameter = 2.0 * volume.spacing * seed.radius;
    grain.quality = 0.0;
    grains.push_back(grain);
  }
  return grains;
}

void add_warnings(Segmentation& result) {
  std::vector<double> qualities;
  for (const Bead& bead : result.beads) qualities.push_back(bead.quality);
  if (median(qualities) < 0.5)
    result.warnings.push_back("most objects are not spherical: diameters and errors mean little");
  if (result.grains.size() > result.beads.size())
    result.warnings.push_back(
        fmt::format("{} objects rejected (boundary not spherical) against {} beads: irregular grains, or the "
                    "other polarity (--beads)?",
                    result.grains.size(), result.beads.size()));
  else if (!result.grains.empty())
    result.warnings.push_back(fmt::format(
        "{} objects rejected, not in the table (boundary not spherical): broken beads, or other bodies",
        result.grains.size()));
  if (result.measured && !result.measured->polymer_seen)
    result.warnings.push_back(
        "polymer cannot be distinguished from its surroundings: every bridge is undetermined");
  if (!result.specimen)
    result.warnings.push_back(
        "no container found (a tube along z): porosity is that of the whole image, walls are not known");
}

/// The container's inside; where the beads end free, up to the outermost bead.
Specimen specimen_of(const Volume& volume, const Container& container, const std::vector<Bead>& beads) {
  double lowest = beads.front().centre.z(), highest = lowest;
  for (const Bead& bead : beads) {
    lowest = std::min(lowest, bead.centre.z() - 0.5 * bead.diameter);
    highest = std::max(highest, bead.centre.z() + 0.5 * bead.diameter);
  }
  const auto place = [&](double voxel, int axis) { return volume.origin[axis] + volume.spacing * voxel; };
  const double last = static_cast<double>(volume.size[2]) - 0.5;
  Specimen specimen;
  specimen.diameter = 2.0 * container.radius * volume.spacing;
  specimen.axis_x = place(container.axis_x, 0);
  specimen.axis_y = place(container.axis_y, 1);
  specimen.bottom = container.bottom ? place(*container.bottom, 2) : std::max(lowest, place(-0.5, 2));
  specimen.height =
      (container.top ? place(*container.top, 2) : std::min(highest, place(last, 2))) - specimen.bottom;
  return specimen;
}

/// Beads within one mean diameter of the picture's sides.
void flag_cut(const Volume& volume, std::vector<Bead>& beads) {
  const double margin = mean_diameter(beads);
  for (Bead& bead : beads)
    for (int axis = 0; axis < 3; ++axis) {
      const double low = volume.origin[axis] - 0.5 * volume.spacing;
      const double high = low + volume.spacing * static_cast<double>(volume.size[axis]);
      bead.boundary |= bead.centre[axis] < low + margin || bead.centre[axis] > high - margin;
    }
}

void flag_boundaries(const Volume& volume, Segmentation& result) {
  flag_cut(volume, result.beads);
  if (!result.specimen) return;
  Packing packing{result.beads, {}, *result.specimen, {}};
  flag_boundary(packing);
  for (std::size_t n = 0; n < result.beads.size(); ++n) result.beads[n].boundary |= packing.beads[n].boundary;
}

BeadSearch search_with(const Volume& volume, const SegmentOptions& options) {
  std::optional<double> least_radius;
  if (options.least_diameter) {
    const auto longest = *std::max_element(volume.size.begin(), volume.size.end());
    const double edge = volume.spacing * static_cast<double>(longest);
    if (*options.least_diameter > edge)
      bad_input("least bead diameter: found {:.6g} um, expected at most {:.6g} um, the volume's longest edge",
                1e6 * *options.least_diameter, 1e6 * edge);
    least_radius = 0.5 * *options.least_diameter / volume.spacing;
  }
  return search_beads(volume, options.tone, least_radius,
                      [&](const BeadSearch& tried) { return ball_share(volume, tried, options.cutoff); });
}

Segmentation segmented(const Volume& volume, const BeadSearch& search, const SegmentOptions& options,
                       const std::vector<std::string>& defects) {
  Segmentation result;
  result.warnings = defects;
  FittedBeads fitted = fit_beads(volume, search, options.cutoff);
  if (fitted.fits.empty())
    bad_input(
        "no beads found: {} bodies in a volume of {} x {} x {} voxels, none with a spherical "
        "boundary{}{}",
        search.seeds.size(), volume.size[0], volume.size[1], volume.size[2],
        result.warnings.empty() ? "" : "; ", fmt::join(result.warnings, "; "));
  sort_fits(fitted.fits);
  fit_with_polymer(volume, search.container, options.cutoff, fitted);
  result.levels = search.levels;
  result.bright_beads = search.bright;
  result.beads = beads_of(volume, fitted);
  if (search.container) result.specimen = specimen_of(volume, *search.container, result.beads);
  flag_boundaries(volume, result);
  result.bridges = candidate_bridges(result.beads, options.cutoff * mean_diameter(result.beads));
  if (options.bridges)
    result.measured = measure_bridges(volume, fitted, search.container, *options.bridges, result.bridges);
  result.porosity = porosity_of(volume, result.specimen, result.levels.threshold, result.bright_beads);
  release(volume);
  result.blur = fitted.blur * volume.spacing;
  result.noise = fitted.noise.sd / (result.levels.bright - result.levels.dark);
  result.noise_correlation = fitted.noise.correlation.size() > 1 ? fitted.noise.correlation[1] : 0.0;
  if (fitted.rings) result.rings = fitted.rings->rms / (result.levels.bright - result.levels.dark);
  result.rejected = fitted.rejected;
  result.grains = grains_of(volume, fitted);
  add_warnings(result);
  return result;
}

void require_size(const std::array<std::size_t, 3>& size, const std::string& why) {
  constexpr std::size_t fewest = 16;
  if (*std::min_element(size.begin(), size.end()) < fewest)
    bad_input("volume of {} x {} x {} voxels, expected at least {} along each axis{}", size[0], size[1],
              size[2], fewest, why);
}

std::string words_of(const Box& box) {
  return fmt::format(
      "outer planes hold one grey value and are left out; voxels x {} to {}, y {} to {}, z {} to {}, from 0 "
      "on, "
      "are used",
      box.low[0], box.high[0] - 1, box.low[1], box.high[1] - 1, box.low[2], box.high[2] - 1);
}

/// Of a volume without padding, whose first slice is the `first_slice`-th of the one it was taken from.
Segmentation segmented_unpadded(const Volume& volume, const SegmentOptions& options, std::size_t first_slice,
                                std::vector<std::string> defects) {
  const BeadSearch search = search_with(volume, options);
  for (auto& defect : image_defects(volume, search.histogram, first_slice))
    defects.push_back(std::move(defect));
  if (!may_refine(volume) || !mostly_spherical(search) ||
      typical_radius(search.seeds) > kThresholds.refined_below)
    return segmented(volume, search, options, defects);
  Volume finer = resampled(volume, {2.0, 2.0, 2.0});
  finer.spacing *= 0.5;
  return segmented(finer, search_with(finer, options), options, defects);
}

}  // namespace

Segmentation segment(const Volume& volume, const SegmentOptions& options) {
  require_size(volume.size, "");
  const Box whole{{}, volume.size}, box = without_padding(volume);
  if (box == whole) return segmented_unpadded(volume, options, 0, {});
  const Volume part = part_of(volume, box);
  require_size(part.size, "; " + words_of(box));
  return segmented_unpadded(part, options, box.low[2], {words_of(box)});
}

}  // namespace pendular::segmentation
