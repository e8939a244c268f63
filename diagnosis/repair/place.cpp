#include "diagnosis/repair/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/kinds/similarity.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

/// The range of most of some values.
std::pair<double, double> range_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(kThresholds.tail), at(1.0 - kThresholds.tail)};
}

std::string words_of(const Place& place) {
  if (place.count() == 0)
    return fmt::format(
        "Nowhere among {} beads do experiment and the simulation as believed part beyond noise.",
        place.ids.size());
  Vec3 low = place.rest.front(), high = low;
  for (const Vec3& p : place.rest) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 middle = 0.5 * (low + high);
  const double radius = 0.25 * (high - low).head<2>().sum();
  std::vector<double> heights, distances;
  double change = 0.0, sigma = 0.0, weight = 0.0;
  for (std::size_t k = 0; k < place.rest.size(); ++k) {
    if (!place.stands_out(k)) continue;
    heights.push_back((place.rest[k].z() - low.z()) / (high.z() - low.z()));
    distances.push_back((place.rest[k] - middle).head<2>().norm() / radius);
    const double w = place.misfit.value[k];
    change += w * place.stiffness.change[k], sigma += w * place.stiffness.sigma[k], weight += w;
  }
  change /= weight, sigma /= weight;
  const auto [bottom, top] = range_of(heights);
  const auto [inner, outer] = range_of(distances);
  std::string text = fmt::format(
      "Experiment and the simulation as believed part about {} of {} beads, at {:.2f} to {:.2f} of the "
      "height and {:.2f} to {:.2f} "
      "of the radius",
      place.count(), place.ids.size(), bottom, top, inner, outer);
  if (std::fabs(change) < 2.0 * sigma)
    return text + "; whether they are softer or stiffer there cannot be told.";
  const double factor = std::exp(change);
  return text + fmt::format("; the experiment is {} there by {:.0f} \u00b1 {:.0f} %.",
                            change < 0.0 ? "softer" : "stiffer", 100.0 * std::fabs(factor - 1.0),
                            100.0 * factor * sigma);
}

}  // namespace

std::size_t Place::count() const {
  return static_cast<std::size_t>(
      std::count_if(misfit.value.begin(), misfit.value.end(), [&](double value) { return value > cut; }));
}

Place place_of(const ScannedMotion& scan, const dem_core::Simulation& specimen,
               const std::vector<std::int64_t>& ids_of_specimen) {
  std::map<std::int64_t, int> index;
  for (std::size_t k = 0; k < ids_of_specimen.size(); ++k) index[ids_of_specimen[k]] = static_cast<int>(k);
  Place place;
  place.strain = scan.strain, place.ids = scan.ids, place.rest = scan.rest;
  std::vector<int> bead;
  for (std::int64_t id : scan.ids) {
    bead.push_back(index.at(id));
    place.diameter.push_back(2.0 * specimen.beads.radius[static_cast<std::size_t>(bead.back())]);
  }
  MovedBeads beads{scan.rest,
                   specimen.beads.mean_diameter(),
                   without_rigid_motion(scan.rest, scan.measured),
                   scan.sigma,
                   {}};
  std::vector<Vec3> simulated(scan.rest.size(), Vec3::Zero());
  for (const auto& member : scan.simulated) {
    beads.members.push_back(without_rigid_motion(scan.rest, member));
    for (std::size_t k = 0; k < simulated.size(); ++k)
      simulated[k] += member[k] / static_cast<double>(scan.simulated.size());
  }
  place.misfit = place_misfit(beads);
  place.cut = std::max(
      place.misfit.threshold,
      kThresholds.share_of_largest * *std::max_element(place.misfit.value.begin(), place.misfit.value.end()));
  place.stiffness = place_stiffness(specimen, scan.strain, bead, simulated, beads);
  place.words = words_of(place);
  return place;
}

}  // namespace pendular::diagnosis
