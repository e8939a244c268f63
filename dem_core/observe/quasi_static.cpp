#include "dem_core/observe/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pendular::dem_core {

double inertial_number(double rate, double diameter, double density, double stress) {
  if (!(stress > 0.0)) return std::numeric_limits<double>::infinity();
  return std::fabs(rate) * diameter * std::sqrt(density / stress);
}

double unbalanced_force(const Simulation& simulation, const Forces& forces) {
  double net = 0.0, acting = 0.0, count = 0.0;
  for (const auto& force : forces.net) net += force.norm();
  const auto add = [&](double force) {
    acting += force;
    count += 1.0;
  };
  for (std::size_t p = 0; p < forces.pair.size(); ++p) {
    const double force = forces.pair[p].norm();
    if (simulation.pairs[p].bond >= 0 || force > 0.0) add(force);
  }
  for (const auto* platen : {&forces.bottom, &forces.top})
    for (const auto& contact : *platen) add(contact.force.norm());
  if (acting == 0.0) return 0.0;
  return (net / static_cast<double>(forces.net.size())) / (acting / count);
}

std::optional<QuasiStatic> quasi_static(const std::vector<CurveRow>& rows) {
  const auto features = curve_features(rows);
  if (!features) return std::nullopt;
  QuasiStatic worst;
  double reached = -1.0;
  for (const auto& row : rows) {
    if (row.strain <= reached) continue;  // unloading and reloading
    reached = row.strain;
    if (row.strain < features->fit_from || row.strain > features->fit_to) continue;
    worst.inertial_number = std::max(worst.inertial_number, row.inertial_number);
    worst.unbalanced_force = std::max(worst.unbalanced_force, row.unbalanced_force);
  }
  return worst;
}

}  // namespace pendular::dem_core
