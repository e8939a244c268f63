#include "diagnosis/plausible.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pendular::diagnosis {
namespace {

// A packing's modulus is some ten times its polymer's; outside these shares of it the unit must be wrong.
constexpr double kLeastModulus = 0.1, kLargestModulus = 1e3;

double largest(const std::vector<double>& values) {
  double found = 0.0;
  for (double v : values) found = std::max(found, std::fabs(v));
  return found;
}

void check_strain(const Observation& observation, const std::string& column) {
  const double found = largest(observation.column(column));
  if (found > 0.6)
    bad_input("{}: {}: found values up to {:.4g}, expected fractions below 0.6 (is it in per cent?)",
              observation.file.string(), column, found);
  if (found == 0.0)
    bad_input("{}: {}: found only zeros, expected a test that strains", observation.file.string(), column);
}

void check_modulus(const Observation& observation, const std::string& column, double modulus,
                   double polymer) {
  const double share = modulus / polymer;
  if (share > kLeastModulus && share < kLargestModulus) return;
  bad_input(
      "{}: {}: found a stiffness of {:.3g} Pa, {:.2g} times the polymer's {:.3g} Pa; expected some ten times "
      "(is the column in {}?)",
      observation.file.string(), column, modulus, share, polymer, share < 1.0 ? "MPa or kPa" : "mPa");
}

void check_compression(const Observation& observation, double polymer) {
  check_strain(observation, "strain");
  const auto& strain = observation.column("strain");
  const auto& stress = observation.column("stress_pa");
  const auto peak = std::max_element(stress.begin(), stress.end()) - stress.begin();
  if (stress[peak] <= 0.0 || strain[peak] <= 0.0)
    bad_input("{}: stress_pa: found no positive stress at a positive strain, expected compression positive",
              observation.file.string());
  check_modulus(observation, "stress_pa", stress[peak] / strain[peak], polymer);
}

void check_series(const Observation& observation, double polymer) {
  if (observation.has("E_p_pa") == observation.has("W"))
    bad_input("{}: found {} of the columns E_p_pa and W, expected one", observation.file.string(),
              observation.has("W") ? "both" : "neither");
  if (observation.has("W") && largest(observation.column("W")) > 0.3)
    bad_input("{}: W: found {:.4g}, expected fractions below 0.3 (is it in per cent?)",
              observation.file.string(), largest(observation.column("W")));
  const auto& modulus = observation.column("modulus_pa");
  for (std::size_t k = 0; k < modulus.size(); ++k)
    check_modulus(observation, "modulus_pa", modulus[k],
                  observation.has("E_p_pa") ? observation.column("E_p_pa")[k] : polymer);
}

void check_bridges(const Observation& observation) {
  for (const char* stiffness : {"kn", "kt"}) {
    const std::string value = std::string(stiffness) + "_n_per_m",
                      sigma = std::string(stiffness) + "_sigma_n_per_m";
    if (observation.has(value) != observation.has(sigma))
      bad_input("{}: found {} without {}, expected both or neither", observation.file.string(),
                observation.has(value) ? value : sigma, observation.has(value) ? sigma : value);
  }
  if (!observation.has("kn_n_per_m") && !observation.has("kt_n_per_m"))
    bad_input("{}: found neither kn_n_per_m nor kt_n_per_m, expected at least one",
              observation.file.string());
  for (const auto& [name, column] : observation.columns)
    if (!name.ends_with("sigma_n_per_m") && *std::min_element(column.begin(), column.end()) <= 0.0)
      bad_input("{}: {}: found {:.4g}, expected positive values", observation.file.string(), name,
                *std::min_element(column.begin(), column.end()));
  const auto& d = observation.column("d_um");
  const auto& diameter = observation.column("D_um");
  for (std::size_t k = 0; k < d.size(); ++k)
    if (d[k] >= diameter[k])
      bad_input("{}: found a bridge of {:.4g} um on beads of {:.4g} um, expected it to be thinner",
                observation.file.string(), d[k], diameter[k]);
}

/// A length that must be of the order of the beads.
void check_length(const Observation& observation, const std::string& column, double least, double most) {
  const auto& values = observation.column(column);
  std::vector<double> sorted = values;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];
  if (median < least || median > most)
    bad_input("{}: {}: found a median of {:.4g} um, expected {:.3g} to {:.3g} um for these beads",
              observation.file.string(), column, median, least, most);
}

/// Uncertainties of zero tell nothing: the column counts as not given.
void drop_empty_sigmas(Experiment& experiment, Observation& observation) {
  for (auto it = observation.columns.begin(); it != observation.columns.end();) {
    const auto& [name, column] = *it;
    const bool sigma = name.find("sigma") != std::string::npos;
    if (sigma && *std::min_element(column.begin(), column.end()) < 0.0)
      bad_input("{}: {}: found a negative standard deviation", observation.file.string(), name);
    if (!sigma || *std::min_element(column.begin(), column.end()) > 0.0) {
      ++it;
      continue;
    }
    experiment.warnings.push_back(observation.name + ": " + name +
                                  " holds zeros; it counts as not given, and the scatter is used instead");
    it = observation.columns.erase(it);
  }
}

}  // namespace

void check_plausible(Experiment& experiment, Observation& observation) {
  const Sample sample = experiment.sample_of(observation);
  const double polymer = sample.bridges.youngs_modulus, diameter = 1e6 * sample.beads.diameter;
  for (const char* strain : {"strain", "lateral_strain"})
    if (observation.has(strain) && observation.kind != Kind::compression) check_strain(observation, strain);
  if (observation.kind == Kind::compression) check_compression(observation, polymer);
  if (observation.kind == Kind::modulus_series) check_series(observation, polymer);
  if (observation.kind == Kind::bridge_stiffness) check_bridges(observation);
  if (observation.kind == Kind::bridge_diameters)
    check_length(observation, "d_um", 0.01 * diameter, 0.99 * diameter);
  if (observation.kind == Kind::bridge_gaps)
    check_length(observation, "gap_um", -0.1 * diameter, 0.5 * diameter);
  if (observation.kind == Kind::coordination) {
    const auto& z = observation.column("z");
    if (*std::min_element(z.begin(), z.end()) < 0.0 || largest(z) > 14.0)
      bad_input("{}: z: found {:.4g}, expected bridges per bead, 0 to 14", observation.file.string(),
                largest(z));
  }
  drop_empty_sigmas(experiment, observation);
}

}  // namespace pendular::diagnosis
