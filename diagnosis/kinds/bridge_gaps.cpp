#include <cmath>

#include "base/error.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr double kError = 0.3;          // of the simulation, um
constexpr std::size_t kUsualRows = 60;  // of a usual sample
constexpr double kUsualError = 0.5;     // of its rows, um
constexpr double kNoGap = 1e-4;         // over the beads' diameter: none is resolved

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  const double diameter = kUm * believed.beads.diameter;
  check_length(observation, "gap_um", -0.1 * diameter, 0.5 * diameter);
  check_sigma(observation, "sigma_um", diameter);
  const double widest = largest_of(observation.column("gap_um"));
  if (widest > 0.0 && widest < kNoGap * diameter)
    bad_input(
        "{}: gap_um: found none wider than {:.3g} um, expected gaps between beads of {:.3g} um (is it in "
        "{}?)",
        observation.file.string(), widest, diameter, widest > 1e-3 * kNoGap * diameter ? "mm" : "m");
}

Columns simulate(const Observation&, const Simulated& simulated) {
  const Sample& sample = simulated.sample;
  return {{"gap_um", {kUm * sample.bridges.gap + effects::spread_of_bridges(sample).gap_excess}}};
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

Columns planned(const Observation&, const Sample& believed, double) {
  return {{"gap_um", std::vector<double>(kUsualRows, kUm * believed.bridges.gap)}};
}

/// Gaps spread as much as their mean is above the narrowest, which is that of an exponential, and by errors.
Columns shown(const Observation& planned, const Columns& simulated) {
  const double middle = mean_of(simulated.at("gap_um")), excess = middle - mean_of(planned.column("gap_um"));
  return {{"gap_um", spread_about(middle, std::hypot(excess, kUsualError), kUsualRows)},
          {"sigma_um", std::vector<double>(kUsualRows, kUsualError)}};
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
                         .usual = UsualMeasurement{"gaps of sixty bridges, measured in a tomogram",
                                                   "how far apart the beads of a bridge are", 0.7},
                         .of_bridges = true,
                         .check = check,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .perturbed = perturbed,
                         .planned = planned,
                         .shown = shown,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
