#include "packing/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/progress.h"
#include "packing/bridges.h"
#include "packing/statistics.h"
#include "packing/touching.h"

namespace pendular {
namespace {

constexpr double kClearly = 0.1;  // of a gap's standard error
constexpr double kFew = 0.05;     // pairs per bead

}  // namespace

bool states_errors(const std::vector<Bead>& beads) {
  return std::any_of(beads.begin(), beads.end(),
                     [](const Bead& bead) { return bead.sigma_centre > 0.0 || bead.sigma_diameter > 0.0; });
}

Diameters diameters_used(const Sample& sample, bool errors_stated) {
  if (sample.beads.diameters != Diameters::automatic) return sample.beads.diameters;
  return errors_stated ? Diameters::measured : Diameters::drawn;
}

Diameters diameters_used(const Sample& sample, const std::vector<Bead>& beads) {
  return diameters_used(sample, states_errors(beads));
}

Packing packing_of(std::vector<Bead> beads, const Sample& sample) {
  Packing packing;
  const bool measured = diameters_used(sample, beads) == Diameters::measured;
  packing.beads = measured ? closed_contacts(std::move(beads)) : std::move(beads);
  packing.specimen = specimen_around(packing.beads, sample.specimen.diameter, sample.specimen.height);
  flag_boundary(packing);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  return packing;
}

void warn_of_open_contacts(const std::vector<Bead>& beads, const Sample& sample) {
  if (!states_errors(beads) || diameters_used(sample, beads) == Diameters::drawn) return;
  const auto near = candidate_bridges(beads, 0.0);
  const auto overlapping = std::count_if(
      near.begin(), near.end(), [](const Bridge& pair) { return pair.gap < -kClearly * pair.sigma_gap; });
  if (static_cast<double>(overlapping) < kFew * static_cast<double>(beads.size())) return;
  warn(
      fmt::format("{} pairs of beads overlap by errors of measurement, and as many that touch are apart: "
                  "expected their contacts closed by pendular pack with this sample",
                  overlapping));
}

Closing closing(const std::vector<Bead>& measured, const std::vector<Bead>& closed) {
  Closing found;
  found.contacts = touching_pairs(closed);
  double centres = 0.0, diameters = 0.0, in_errors = 0.0, values = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const Bead& bead = measured[k];
    const double moved = (closed[k].centre - bead.centre).squaredNorm();
    const double changed = std::pow(closed[k].diameter - bead.diameter, 2);
    centres += moved, diameters += changed;
    if (bead.sigma_centre > 0.0) in_errors += moved / std::pow(bead.sigma_centre, 2), values += 3.0;
    if (bead.sigma_diameter > 0.0) in_errors += changed / std::pow(bead.sigma_diameter, 2), values += 1.0;
  }
  const auto n = static_cast<double>(measured.size());
  found.centre_rms = std::sqrt(centres / (3.0 * n));
  found.diameter_rms = std::sqrt(diameters / n);
  if (values > 0.0) found.rms_over_errors = std::sqrt(in_errors / values);
  return found;
}

}  // namespace pendular
