#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "diagnosis/kinds/curve_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

// Closer where a curve bends: at its toe.
const std::vector<double> kStrains = {0.001,  0.002, 0.003,  0.0045, 0.006, 0.008, 0.010, 0.0125, 0.015,
                                      0.0175, 0.020, 0.0235, 0.027,  0.031, 0.035, 0.040, 0.045,  0.050,
                                      0.055,  0.060, 0.065,  0.070,  0.075, 0.080, 0.085, 0.090,  0.10,
                                      0.11,   0.12,  0.13,   0.14,   0.15,  0.17,  0.20,  0.25,   0.30};
constexpr double kHalf = 8e-4;         // strain within which rows are read together
constexpr double kLeastStress = 3e-3;  // over the largest: far below it stresses count by their difference
const std::vector<double> kShares = {0.8, 0.6, 0.4, 0.3};  // of the stress at a turn, in its loop
constexpr double kHalfShare = 0.03;                        // of it, within which rows are read together
constexpr double kSameTurn = 1.02;  // over the last strain, up to which loops are looked for
// As it is usually measured: strain from row to row, error of a load cell over the largest force; and a
// modulus over the polymer's that gives the order of the stresses.
constexpr double kLogged = 5e-4, kForceError = 3e-3, kRoughModulus = 10.0;
constexpr double kLasting = 0.7;  // correlation of a load cell's noise from row to row
// Errors of the simulation. By what programs with the same law differ (docs/engines.md): of stresses up to
// failure, correlated along the curve, and beyond it (there 7 to 30 %). Judged: of the strain at which
// platens meet the specimen, and of loops.
constexpr double kStressError = 0.005, kStressReach = 6.0, kFailedError = 0.15, kFailedReach = 1.5,
                 kSeatError = 5e-5, kUnloadingError = 0.006, kHysteresisError = 0.005, kLoopReach = 8.0;
constexpr double kLateUnloadingError = 0.05, kLateHysteresisError = 0.02;  // of loops about failure
constexpr double kFailed = 0.97;  // of the largest stress so far, below which a specimen has failed
constexpr double kLate = 0.8;     // of the strain of failure, beyond which bonds break in loops

void check_order(const Observation& observation) {
  const auto& strain = observation.column("strain");
  if (strain.front() >= *std::max_element(strain.begin(), strain.end()))
    bad_input("{}: strain: found rows from {:.4g} down to {:.4g}, expected them in order of time (reversed?)",
              observation.file.string(), strain.front(), *std::min_element(strain.begin(), strain.end()));
}

/// Unloading turns a test round a few times, rows out of order turn it round at every other one.
void check_turns(const Observation& observation) {
  constexpr double kStep = 0.02;  // of the largest strain: smaller ones may be noise
  const auto& strain = observation.column("strain");
  const double step = kStep * last_strain(observation);
  std::size_t turns = 0;
  bool rising = true;
  double from = strain.front();
  for (const double now : strain) {
    if (std::fabs(now - from) < step) continue;
    turns += (now > from) != rising;
    rising = now > from;
    from = now;
  }
  if (turns > std::max<std::size_t>(3, strain.size() / 4))
    bad_input("{}: strain: found {} turns in {} rows, expected rows in order of time",
              observation.file.string(), turns, strain.size());
}

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  check_strain(observation, "strain");
  check_order(observation);
  check_turns(observation);
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

/// Strain at which the stress of some rows first passes shares of that at the turn, from the turn down or
/// from the bottom up.
std::vector<double> strains_at_shares(const Curve& curve, const Loop& loop, bool down) {
  const std::size_t from = down ? loop.top : loop.bottom,
                    to = down ? loop.bottom : std::min(loop.end, curve.strain.size() - 1);
  std::vector<double> x, y, at;
  for (std::size_t k = from; k <= to; ++k) {
    const double share = curve.stress[k] / curve.stress[loop.top];
    x.push_back(down ? 1.0 - share : share);
    y.push_back(curve.strain[k]);
  }
  for (double share : kShares) at.push_back(down ? 1.0 - share : share);
  return read_at(x, y, at, kHalfShare);
}

/// Secant moduli of unloadings, and how far reloading is from unloading, at shares of the stress at the turn:
/// these do not depend much on where the turn is, which differs where strain was misread.
void add_loops(FeatureList& list, const Observation& observation, const Columns& columns) {
  const double last = last_strain(observation);
  const Curve curve{columns.at("strain"), columns.at("stress_pa")};
  const auto loops = loops_of(curve, kSameTurn * last);
  const auto seen = loops_of({observation.column("strain"), observation.column("stress_pa")}, last);
  for (std::size_t n = 0; n < std::min(seen.size(), loops.size()); ++n) {
    const double turn = curve.strain[loops[n].top], stress = curve.stress[loops[n].top],
                 depth = turn - curve.strain[loops[n].bottom];
    const auto down = strains_at_shares(curve, loops[n], true),
               up = strains_at_shares(curve, loops[n], false);
    for (std::size_t k = 0; k < down.size(); ++k) {
      const std::string at = fmt::format("{}_at_{:.0f}_percent", n + 1, 100.0 * kShares[k]);
      list.ratio("unloading_modulus_" + at, stress * (1.0 - kShares[k]) / (turn - down[k]), down[k], turn);
      list.difference("hysteresis_" + at, (up[k] - down[k]) / depth, down[k], turn);
    }
  }
}

std::vector<double> noise_of(const Observation& observation) {
  if (observation.has("stress_sigma_pa")) return observation.column("stress_sigma_pa");
  const auto& stress = observation.column("stress_pa");
  return std::vector<double>(stress.size(), curve_noise({observation.column("strain"), stress}));
}

/// A stress far above `least`, more than nothing below: its logarithm is log(least) + asinh(stress / 2
/// least), so that a load cell's noise about nothing stays what it is.
double above_nothing(double stress, double least) {
  return 0.5 * (stress + std::hypot(stress, 2.0 * least));
}

std::vector<Feature> readings(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  const double least =
      std::max(kLeastStress * largest_of(observation.column("stress_pa")), mean_of(noise_of(observation)));
  const auto strains = strains_up_to(kStrains, last_strain(observation));
  const auto stress = read_at(columns.at("strain"), columns.at("stress_pa"), strains, kHalf);
  for (std::size_t k = 0; k < strains.size(); ++k)
    if (std::isfinite(stress[k]))
      list.ratio(fmt::format("stress_at_{:.2f}_percent", 100.0 * strains[k]), above_nothing(stress[k], least),
                 strains[k], strains[k]);
  add_loops(list, observation, columns);
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  add_noise(columns["stress_pa"], noise_of(observation), seed, kLasting);
  return columns;
}

const std::map<std::string, double>& landmark_errors() {
  static const std::map<std::string, double> all = {
      {"toe_strain", 1e-3},      {"toe_roundness", 0.1},   {"early_modulus", 0.04},
      {"linear_modulus", 0.015}, {"linear_limit", 2.5e-3}, {"peak_strain", 2.5e-3},
      {"peak_stress", 0.02},     {"softening", 0.1},       {"unloading_modulus", 0.02},
      {"residual_strain", 1e-3}, {"loop_area", 0.1}};
  return all;
}

/// The strain of the last reading of stress before it falls; infinite where it does not fall.
double strain_of_failure(const std::vector<Feature>& features) {
  double largest = 0.0, last = 0.0;
  for (const auto& feature : features) {
    if (!feature.name.starts_with("stress_at")) continue;
    if (feature.value < kFailed * largest) return last;
    largest = std::max(largest, feature.value), last = feature.strain_to;
  }
  return std::numeric_limits<double>::infinity();
}

Columns planned(const Observation&, const Sample& believed, double strain) {
  Columns columns;
  for (int row = 1; row * kLogged < strain * (1.0 + 1e-9); ++row) {
    columns["strain"].push_back(row * kLogged);
    columns["stress_pa"].push_back(kRoughModulus * believed.bridges.youngs_modulus * row * kLogged);
  }
  return columns;
}

Columns shown(const Observation& planned, const Columns& simulated) {
  const auto &strain = simulated.at("strain"), &stress = simulated.at("stress_pa");
  const double last = last_strain(planned);
  Columns columns;
  for (std::size_t k = 0; k < strain.size() && strain[k] <= last; ++k) {
    columns["strain"].push_back(strain[k]);
    columns["stress_pa"].push_back(stress[k]);
  }
  columns["stress_sigma_pa"].assign(columns["strain"].size(), kForceError * largest_of(columns["stress_pa"]));
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  const auto count = static_cast<Eigen::Index>(features.size());
  if (count == 0 || !features.front().name.starts_with("stress_at"))
    return errors_by_name(features, landmark_errors());
  const double failure = strain_of_failure(features);
  Eigen::VectorXd stress = Eigen::VectorXd::Zero(count), failed = stress, unloading = stress,
                  hysteresis = stress, seat = stress;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Feature& feature = features[static_cast<std::size_t>(k)];
    const bool late = feature.strain_to > kLate * failure;
    if (feature.name.starts_with("unloading")) unloading[k] = late ? kLateUnloadingError : kUnloadingError;
    if (feature.name.starts_with("hysteresis"))
      hysteresis[k] = late ? kLateHysteresisError : kHysteresisError;
    if (!feature.name.starts_with("stress_at")) continue;
    stress[k] = kStressError;
    if (feature.strain_to >= failure) failed[k] = kFailedError;
    seat[k] = kSeatError / feature.strain_to;
  }
  Eigen::MatrixXd covariance = errors_along(stress, kStressReach) + errors_along(failed, kFailedReach) +
                               errors_along(unloading, kLoopReach) + errors_along(hysteresis, kLoopReach);
  covariance += Eigen::MatrixXd(seat.cwiseAbs2().asDiagonal());
  return covariance;
}

}  // namespace

/// Engineering stress against strain from platen displacement, in order of time; strain may go down.
/// Readings: the stress at fixed strains of first loading, secant moduli of unloadings and the hysteresis of
/// loops.
const Kind& kinds::compression() {
  static const Kind kind{.name = "compression",
                         .required = {"strain", "stress_pa"},
                         .optional = {"stress_sigma_pa"},
                         .least_rows = 8,
                         .strain_by = StrainBy::machine,
                         .check = check,
                         .course = course,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .readings = readings,
                         .perturbed = perturbed,
                         .planned = planned,
                         .shown = shown,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
