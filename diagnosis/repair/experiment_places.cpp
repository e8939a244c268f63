#include "diagnosis/repair/experiment_places.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "diagnosis/experiment/specimens.h"
#include "diagnosis/kinds/kind.h"
#include "effects/compress.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e-6;
constexpr std::size_t kFewestMembers = 3;

std::vector<Vec3> vectors_at(const Columns& columns, double strain, const char* x, const char* y,
                             const char* z) {
  std::vector<Vec3> all;
  const auto& strains = columns.at("strain");
  for (std::size_t k = 0; k < strains.size(); ++k)
    if (strains[k] == strain) all.push_back(kUm * Vec3(columns.at(x)[k], columns.at(y)[k], columns.at(z)[k]));
  return all;
}

/// Stated of a component of a displacement at this strain: rms, m; of the beads' centres where it is not.
double sigma_at(const Observation& observation, double strain) {
  double square = 0.0, count = 0.0;
  if (observation.has("sigma_um")) {
    const auto& strains = observation.column("strain");
    for (std::size_t k = 0; k < strains.size(); ++k)
      if (strains[k] == strain) square += std::pow(kUm * observation.column("sigma_um")[k], 2), count += 1.0;
  } else {
    for (const auto& bead : read_beads(observation.beads))
      square += 2.0 * bead.sigma_centre * bead.sigma_centre, count += 1.0;
  }
  return std::sqrt(square / count);
}

ScannedMotion scan_of(const Observation& observation, const Overlay& overlay) {
  ScannedMotion scan;
  const auto& strains = observation.column("strain");
  scan.strain = *std::min_element(strains.begin(), strains.end());
  scan.rest = vectors_at(observation.columns, scan.strain, "x_um", "y_um", "z_um");
  scan.measured = vectors_at(observation.columns, scan.strain, "ux_um", "uy_um", "uz_um");
  scan.sigma = sigma_at(observation, scan.strain);
  for (std::size_t k = 0; k < strains.size(); ++k)
    if (strains[k] == scan.strain)
      scan.ids.push_back(static_cast<std::int64_t>(observation.column("bead_id")[k]));
  const auto& runs = overlay.repaired.size() >= kFewestMembers ? overlay.repaired : overlay.simulated;
  for (const Columns& columns : runs)
    scan.simulated.push_back(vectors_at(columns, scan.strain, "ux_um", "uy_um", "uz_um"));
  return scan;
}

Place place_in(const Experiment& experiment, const Condition& condition, std::size_t index,
               MemberPackings& packings, const Overlay& overlay) {
  const Packing packing = read_packing(packings.of(condition, 1, condition.sample).file);
  const dem_core::Simulation specimen =
      effects::actual_simulation(effects::actual_specimen(packing, condition.sample, 1));
  std::vector<std::int64_t> ids;
  for (const auto& bead : packing.beads) ids.push_back(bead.id);
  const Observation& observation = experiment.observations[index];
  Place place = place_of(scan_of(observation, overlay), specimen, ids);
  place.observation = observation.name;
  return place;
}

}  // namespace

std::vector<Place> places_in(const Experiment& experiment, const BankPlan& plan, MemberPackings& packings,
                             const std::vector<Overlay>& overlays, std::vector<std::string>& warnings) {
  std::vector<Place> places;
  for (const auto& condition : plan.conditions)
    for (std::size_t index : condition.observations) {
      const Observation& observation = experiment.observations[index];
      if (observation.kind != &kinds::displacements() || observation.beads.empty()) continue;
      try {
        if (overlays[index].simulated.size() < kFewestMembers)
          throw ComputationFailed("expected at least three simulated scans");
        places.push_back(place_in(experiment, condition, index, packings, overlays[index]));
      } catch (const ComputationFailed& failure) {
        warnings.push_back(observation.name +
                           ": where in the specimen it differs is not shown: " + failure.what());
      }
    }
  return places;
}

}  // namespace pendular::diagnosis
