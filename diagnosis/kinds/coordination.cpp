#include <algorithm>

#include "base/error.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

constexpr double kMostBridges = 14.0;                      // per bead
constexpr double kRoughBridges = 6.0, kUsualError = 0.05;  // as it is usually measured
constexpr double kError = 0.01;                            // of the simulation

void check(const Sample&, Observation& observation, std::vector<std::string>&) {
  const auto& z = observation.column("z");
  if (*std::min_element(z.begin(), z.end()) < 0.0 || largest_of(z) > kMostBridges)
    bad_input(
        "{}: z: found {:.4g}, expected bridges per bead, 0 to 14", observation.file.string(),
        *std::min_element(z.begin(), z.end()) < 0.0 ? *std::min_element(z.begin(), z.end()) : largest_of(z));
  check_sigma(observation, "z_sigma", kMostBridges);
}

/// It is known before the test.
void course(const Observation&, Sample::Compression&) {}

Columns simulate(const Observation&, const Simulated& simulated) {
  return {{"z", {simulated.test->coordination}}};
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::network);
  list.ratio("coordination", mean_of(columns.at("z")));
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  add_stated_noise(columns, "z", "z_sigma", seed);
  return columns;
}

Columns planned(const Observation&, const Sample&, double) {
  return {{"z", {kRoughBridges}}, {"z_sigma", {kUsualError}}};
}

Columns shown(const Observation& planned, const Columns& simulated) {
  return {{"z", simulated.at("z")}, {"z_sigma", planned.column("z_sigma")}};
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(features, {{"coordination", kError}});
}

}  // namespace

/// Bridges per bead whose centre is farther than one mean diameter from wall and platens.
const Kind& kinds::coordination() {
  static const Kind kind{.name = "coordination",
                         .required = {"z", "z_sigma"},
                         .scale = Scale::network,
                         .usual = UsualMeasurement{"bridges per bead, counted in a tomogram",
                                                   "how many of the near pairs have a bridge", 0.5},
                         .check = check,
                         .course = course,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .perturbed = perturbed,
                         .planned = planned,
                         .shown = shown,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
