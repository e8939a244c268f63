#include <cmath>

#include "base/error.h"
#include "base/line_fit.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/funicular.h"

namespace pendular::diagnosis {
namespace {

constexpr double kMostPolymer = 0.3;
constexpr double kOtherPolymer = 1e3;  // most that a polymer is stiffer or softer than the believed one

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  if (observation.has("E_p_pa") == observation.has("W"))
    bad_input("{}: found {} of the columns E_p_pa and W, expected one", observation.file.string(),
              observation.has("W") ? "both" : "neither");
  if (observation.has("W") && largest_of(observation.column("W")) > kMostPolymer)
    bad_input("{}: W: found {:.4g}, expected fractions below 0.3 (is it in per cent?)",
              observation.file.string(), largest_of(observation.column("W")));
  if (observation.has("E_p_pa"))
    for (const double polymer : observation.column("E_p_pa"))
      if (polymer < believed.bridges.youngs_modulus / kOtherPolymer ||
          polymer > believed.bridges.youngs_modulus * kOtherPolymer)
        bad_input(
            "{}: E_p_pa: found {:.3g} Pa beside a believed {:.3g} Pa, expected polymers alike (is it in {}?)",
            observation.file.string(), polymer, believed.bridges.youngs_modulus,
            polymer < believed.bridges.youngs_modulus ? "MPa or kPa" : "mPa");
  if (observation.has("W"))
    for (const double content : observation.column("W"))
      if (content <= 0.0)
        bad_input("{}: W: found {:.4g}, expected positive fractions", observation.file.string(), content);
  const auto& modulus = observation.column("modulus_pa");
  check_sigma(observation, "modulus_sigma_pa", largest_of(modulus));
  for (std::size_t k = 0; k < modulus.size(); ++k)
    check_modulus(
        observation, "modulus_pa", modulus[k],
        observation.has("E_p_pa") ? observation.column("E_p_pa")[k] : believed.bridges.youngs_modulus);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  const bool by_content = columns.contains("W");
  const auto &at = columns.at(by_content ? "W" : "E_p_pa"), &modulus = columns.at("modulus_pa");
  std::vector<double> x, y, beyond;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (by_content && at[k] > effects::kFunicularContent) {
      beyond.push_back(std::log(modulus[k]));
      continue;
    }
    x.push_back(std::log(at[k])), y.push_back(std::log(modulus[k]));
  }
  if (!y.empty()) list.ratio("modulus_level", std::exp(mean_of(y)));
  if (y.size() >= 2 && x.back() != x.front()) list.difference("modulus_exponent", line_through(x, y).slope);
  if (!beyond.empty()) list.ratio("modulus_beyond_funicular", std::exp(mean_of(beyond)));
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  add_stated_noise(columns, "modulus_pa", "modulus_sigma_pa", seed);
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(
      features, {{"modulus_level", 0.02}, {"modulus_exponent", 0.03}, {"modulus_beyond_funicular", 0.03}});
}

}  // namespace

/// E against the polymer's modulus or its content; a condition for each row that supports the others
/// (conditions.h), simulated columns by columns_of_series().
const Kind& kinds::modulus_series() {
  static const Kind kind{.name = "modulus_series",
                         .required = {"modulus_pa", "modulus_sigma_pa"},
                         .optional = {"E_p_pa", "W"},
                         .strain_by = StrainBy::machine,
                         .check = check,
                         .landmarks = landmarks,
                         .perturbed = perturbed,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
