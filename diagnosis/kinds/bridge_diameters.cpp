#include <algorithm>
#include <cmath>

#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr std::size_t kUsualRows = 60;  // of a usual sample
constexpr double kUsualError = 1.5;     // of its rows, um
constexpr double kRounding = 1e-12;     // what remains of the spread of equal numbers

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  const double diameter = kUm * believed.beads.diameter;
  check_length(observation, "d_um", 0.01 * diameter, 0.99 * diameter);
  check_sigma(observation, "sigma_um", diameter);
}

Columns simulate(const Observation& observation, const Simulated& simulated) {
  const Sample& sample = simulated.sample;
  const double spread = effects::spread_of_bridges(sample).diameter_sd;
  return {{"d_um", spread_about(kUm * sample.bridges.diameter, spread, observation.rows())}};
}

/// The spread is the bridges' own: stated errors are taken off.
std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::bridge);
  const auto& d = columns.at("d_um");
  const double middle = mean_of(d);
  double square = 0.0, stated = 0.0;
  for (double one : d) square += (one - middle) * (one - middle);
  if (const auto sigma = columns.find("sigma_um"); sigma != columns.end())
    for (double one : sigma->second) stated += one * one / static_cast<double>(d.size());
  const double variance = square / static_cast<double>(d.size() - 1) - stated;
  const double spread = std::sqrt(std::max(0.0, variance)) / middle;
  list.ratio("diameter_mean", middle);
  list.difference("diameter_spread", spread > kRounding ? spread : 0.0);
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  draw_rows_again(columns, seed);
  if (columns.contains("sigma_um")) misstate(columns.at("sigma_um"), seed);
  return columns;
}

Columns planned(const Observation&, const Sample& believed, double) {
  return {{"d_um", std::vector<double>(kUsualRows, kUm * believed.bridges.diameter)}};
}

/// The spread of what is read is that of the bridges and of the errors.
Columns shown(const Observation&, const Columns& simulated) {
  const auto& d = simulated.at("d_um");
  const double middle = mean_of(d);
  double square = 0.0;
  for (double one : d) square += (one - middle) * (one - middle) / static_cast<double>(d.size() - 1);
  return {{"d_um", spread_about(middle, std::hypot(std::sqrt(square), kUsualError), d.size())},
          {"sigma_um", std::vector<double>(d.size(), kUsualError)}};
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(features, {{"diameter_mean", 0.005}, {"diameter_spread", 0.005}});
}

}  // namespace

/// A sample of measured necks. Simulated: of the stated mean, and of the stated spread as effects change it
/// (Effect::single_bridges).
const Kind& kinds::bridge_diameters() {
  static const Kind kind{.name = "bridge_diameters",
                         .required = {"d_um"},
                         .optional = {"sigma_um"},
                         .least_rows = 4,
                         .scale = Scale::bridge,
                         .usual = UsualMeasurement{"necks of sixty bridges, measured in a tomogram",
                                                   "how thick bridges are, and how much they differ", 0.5},
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
