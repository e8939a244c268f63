#include "sweep/estimate.h"

#include <cmath>

#include "dem_core/drive/run_length.h"

namespace pendular::sweep {
namespace {

// As measured on a specimen of a hundred beads, 500 rows and 5 frames.
constexpr double kBytesPerRow = 160.0, kBytesPerBeadAndFrame = 240.0, kBytesPerBeadOfCheckpoint = 1250.0;

double beads_of(const RunRequest& request) {
  if (request.packing.beads > 0) return static_cast<double>(request.packing.beads);
  const Sample& sample = request.sample;
  const double section = 0.25 * M_PI * sample.specimen.diameter * sample.specimen.diameter;
  return sample.specimen.volume_fraction * section * sample.specimen.height /
         (M_PI / 6.0 * std::pow(sample.beads.diameter, 3));
}

}  // namespace

Estimate estimate(std::span<const RunRequest> requests) {
  Estimate total;
  for (const auto& request : requests) {
    const auto& compression = request.sample.compression;
    const double beads = beads_of(request);
    total.particle_steps += beads * dem_core::expected_steps(request.sample);
    total.bytes += kBytesPerRow * compression.rows_per_strain * compression.max_strain;
    if (request.keep_all)
      total.bytes += beads * (kBytesPerBeadAndFrame * (compression.frames + 1.0) + kBytesPerBeadOfCheckpoint);
  }
  return total;
}

}  // namespace pendular::sweep
