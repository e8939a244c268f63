#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnosis/curve_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

// Closer where a curve bends: at its toe.
const std::vector<double> kStrains = {0.001, 0.002, 0.003, 0.0045, 0.006, 0.008, 0.010, 0.0125, 0.015,
                                      0.0175, 0.020, 0.0235, 0.027, 0.031, 0.035, 0.040, 0.045, 0.050,
                                      0.055, 0.060, 0.065, 0.070, 0.075, 0.080, 0.085, 0.090, 0.10,
                                      0.11, 0.12, 0.13, 0.14, 0.15, 0.17, 0.20, 0.25, 0.30};
constexpr double kHalf = 8e-4;            // strain within which rows are read together
constexpr double kLeastStress = 3e-3;     // over the largest: below it a logarithm is of noise
constexpr double kDepths[] = {0.2, 0.4, 0.6, 0.8};  // of an unloading, over its strain
constexpr double kSameTurn = 1.02;         // over the last strain, up to which loops are looked for
constexpr double kLasting = 0.7;          // correlation of a load cell's noise from row to row
// Errors of the simulation (docs/diagnose.md): of stresses, correlated along the curve; of the strain at which
// platens meet the specimen; of loops.
constexpr double kStressError = 0.015, kStressReach = 4.0, kSeatError = 1.5e-4, kLoopError = 0.008,
                 kLoopReach = 2.0;

void check_order(const Observation& observation) {
  const auto& strain = observation.column("strain");
  if (strain.front() >= *std::max_element(strain.begin(), strain.end()))
    bad_input("{}: strain: found rows from {:.4g} down to {:.4g}, expected them in order of time (reversed?)",
              observation.file.string(), strain.front(), *std::min_element(strain.begin(), strain.end()));
}

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  check_strain(observation, "strain");
  check_order(observation);
  const auto &strain = observation.column("strain"), &stress = observation.column("stress_pa");
  const auto peak = static_cast<std::size_t>(std::max_element(stress.begin(), stress.end()) - stress.begin());
  if (stress[peak] <= 0.0 || strain[peak] <= 0.0)
    bad_input("{}: stress_pa: found no positive stress at a positive strain, expected compression positive",
              observation.file.string());
  check_modulus(observation, "stress_pa", stress[peak] / strain[peak], believed.bridges.youngs_modulus);
  check_sigma(observation, "stress_sigma_pa", stress[peak]);
}

void course(const Observation& observation, Sample::Compression& course) {
  course.max_strain = std::max(course.max_strain, last_strain(observation));
  course.unload_at.clear();
  for (double strain : unloading_strains({observation.column("strain"), observation.column("stress_pa")}))
    course.unload_at.push_back(strain);
}

Columns simulate(const Observation&, const Simulated& simulated) {
  return columns_of_rows(*simulated.test, "stress_pa", &CurveRow::stress);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  for (const auto& f :
       curve_features({columns.at("strain"), columns.at("stress_pa")}, last_strain(observation))) {
    if (f.logarithm)
      list.ratio(f.name, f.value, f.strain_from, f.strain_to);
    else
      list.difference(f.name, f.value, f.strain_from, f.strain_to);
  }
  return list.take();
}

/// Stress over that at the turn, at depths of an unloading that the observation has, on the way down and up.
void add_loops(FeatureList& list, const Observation& observation, const Columns& columns) {
  const double last = last_strain(observation);
  const Curve seen{observation.column("strain"), observation.column("stress_pa")},
      curve{columns.at("strain"), columns.at("stress_pa")};
  const auto of_seen = loops_of(seen, last), loops = loops_of(curve, kSameTurn * last);
  for (std::size_t n = 0; n < std::min(of_seen.size(), loops.size()); ++n) {
    const double range = seen.strain[of_seen[n].top] - seen.strain[of_seen[n].bottom];
    const Loop& loop = loops[n];
    const double turn = curve.strain[loop.top], stress = curve.stress[loop.top];
    for (const auto& [way, from, to] : {std::tuple("unloading", loop.top, loop.bottom),
                                        {"reloading", loop.bottom, std::min(loop.end, curve.strain.size() - 1)}}) {
      std::vector<double> x, y;
      for (std::size_t k = from; k <= to; ++k) x.push_back(std::fabs(curve.strain[k] - curve.strain[from]));
      for (std::size_t k = from; k <= to; ++k) y.push_back(curve.stress[k] / stress);
      const bool down = from == loop.top;
      std::vector<double> at;
      for (double depth : kDepths)
        at.push_back(down ? depth * range : (turn - curve.strain[loop.bottom]) - depth * range);
      const auto found = read_at(x, y, at, kHalf / 4.0);
      for (std::size_t k = 0; k < at.size(); ++k)
        list.difference(fmt::format("{}_{}_at_{:.0f}_percent", way, n + 1, 100.0 * kDepths[k]), found[k],
                        turn - kDepths[k] * range, turn);
    }
  }
}

std::vector<Feature> readings(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  const auto& seen = observation.column("stress_pa");
  const double least = kLeastStress * *std::max_element(seen.begin(), seen.end());
  const auto strains = strains_up_to(kStrains, last_strain(observation));
  const auto stress = read_at(columns.at("strain"), columns.at("stress_pa"), strains, kHalf);
  for (std::size_t k = 0; k < strains.size(); ++k)
    if (std::isfinite(stress[k]))
      list.ratio(fmt::format("stress_at_{:.2f}_percent", 100.0 * strains[k]), std::max(stress[k], least),
                 strains[k], strains[k]);
  add_loops(list, observation, columns);
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  auto& stress = columns["stress_pa"];
  if (columns.contains("stress_sigma_pa")) {
    add_noise(stress, columns.at("stress_sigma_pa"), seed, kLasting);
  } else {
    const double noise = curve_noise({columns.at("strain"), stress});
    add_noise(stress, std::vector<double>(stress.size(), noise), seed, kLasting);
  }
  return columns;
}

const std::map<std::string, double>& landmark_errors() {
  static const std::map<std::string, double> all = {
      {"toe_strain", 1e-3},   {"toe_roundness", 0.1},  {"early_modulus", 0.04},     {"linear_modulus", 0.015},
      {"linear_limit", 2.5e-3}, {"peak_strain", 2.5e-3}, {"peak_stress", 0.02},       {"softening", 0.1},
      {"unloading_modulus", 0.02}, {"residual_strain", 1e-3}, {"loop_area", 0.1}};
  return all;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  const auto count = static_cast<Eigen::Index>(features.size());
  if (count == 0 || !features.front().name.starts_with("stress_at"))
    return errors_by_name(features, landmark_errors());
  Eigen::VectorXd stress = Eigen::VectorXd::Zero(count), loop = stress, seat = stress;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Feature& feature = features[static_cast<std::size_t>(k)];
    const bool loading = feature.name.starts_with("stress_at");
    (loading ? stress : loop)[k] = loading ? kStressError : kLoopError;
    if (loading) seat[k] = kSeatError / feature.strain_to;
  }
  Eigen::MatrixXd covariance = errors_along(stress, kStressReach) + errors_along(loop, kLoopReach);
  covariance += Eigen::MatrixXd(seat.cwiseAbs2().asDiagonal());
  return covariance;
}

}  // namespace

/// Engineering stress against strain from platen displacement, in order of time; strain may go down. Readings:
/// the stress at fixed strains of first loading, and of each unloading and reloading over that at its turn.
const Kind& kinds::compression() {
  static const Kind kind{.name = "compression",
                         .required = {"strain", "stress_pa"},
                         .optional = {"stress_sigma_pa"},
                         .least_rows = 8,
                         .check = check,
                         .course = course,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .readings = readings,
                         .perturbed = perturbed,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
