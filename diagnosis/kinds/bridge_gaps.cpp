#include "base/error.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr double kError = 0.3;  // of the simulation, um
constexpr double kNoGap = 1e-4;  // over the beads' diameter: none is resolved

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  const double diameter = kUm * believed.beads.diameter;
  check_length(observation, "gap_um", -0.1 * diameter, 0.5 * diameter);
  check_sigma(observation, "sigma_um", diameter);
  const double widest = largest_of(observation.column("gap_um"));
  if (widest > 0.0 && widest < kNoGap * diameter)
    bad_input("{}: gap_um: found none wider than {:.3g} um, expected gaps between beads of {:.3g} um (is it in {}?)",
              observation.file.string(), widest, diameter, widest > 1e-3 * kNoGap * diameter ? "mm" : "m");
}

Columns simulate(const Observation&, const Simulated& simulated) {
  const Sample& sample = simulated.sample;
  return {{"gap_um", {kUm * sample.bridges.gap + effect_magnitude(sample, "bridge_gap_spread")}}};
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::bridge);
  list.difference("gap_mean_um", mean_of(columns.at("gap_um")));
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  draw_rows_again(columns, seed);
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(features, {{"gap_mean_um", kError}});
}

}  // namespace

/// A sample of measured gaps of true bridges.
const Kind& kinds::bridge_gaps() {
  static const Kind kind{.name = "bridge_gaps",
                         .required = {"gap_um"},
                         .optional = {"sigma_um"},
                         .least_rows = 4,
                         .scale = Scale::bridge,
                         .of_bridges = true,
                         .check = check,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .perturbed = perturbed,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
