#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/line_fit.h"
#include "diagnosis/kinds/curve_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

constexpr double kMostLateral = 5.0;  // over the platen's strain, of a specimen that barrels
constexpr double kSignShows = 0.05;   // likewise, beyond noise
constexpr double kRange = 0.03;       // strain over which the first ratio is read
const std::vector<double> kStrains = {0.005, 0.010, 0.015, 0.020, 0.027, 0.035, 0.042, 0.050, 0.060,
                                      0.070, 0.080, 0.09,  0.10,  0.12,  0.15,  0.20,  0.25,  0.30};
constexpr double kHalf = 2e-3, kLasting = 0.7;
// As it is usually measured: strain from picture to picture, error; and a ratio that gives the order.
constexpr double kPictures = 2e-3, kUsualError = 2e-4, kRoughRatio = 0.3;
constexpr double kError = 4e-4, kReach = 3.0;  // of the simulation

void check(const Sample&, Observation& observation, std::vector<std::string>& warnings) {
  check_strain(observation, "strain");
  check_strain(observation, "lateral_strain");
  check_rising(observation, "strain");
  const double axial = last_strain(observation), widest = largest_of(observation.column("lateral_strain"));
  check_sigma(observation, "sigma", axial);
  if (widest > kMostLateral * axial)
    bad_input(
        "{}: lateral_strain: found {:.4g} at platen strains up to {:.4g}, expected no more than these (is it "
        "in "
        "per cent?)",
        observation.file.string(), widest, axial);
  if (observation.column("lateral_strain").back() < -kSignShows * axial)
    warnings.push_back(observation.name +
                       ": the specimen shrinks sideways as it is compressed; expansion is positive");
}

void course(const Observation& observation, Sample::Compression& course) {
  course.max_strain = std::max(course.max_strain, last_strain(observation));
}

Columns simulate(const Observation&, const Simulated& simulated) {
  return columns_of_rows(*simulated.test, "lateral_strain", &CurveRow::lateral_strain);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  const auto &strain = columns.at("strain"), &lateral = columns.at("lateral_strain");
  const double last = last_strain(observation), range = std::min(kRange, last);
  std::vector<double> x, y, late_x, late_y;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    if (strain[k] > last) continue;
    const bool early = strain[k] <= range;
    (early ? x : late_x).push_back(strain[k]);
    (early ? y : late_y).push_back(lateral[k]);
  }
  if (x.size() >= 3) list.difference("lateral_ratio", line_through(x, y).slope, 0.0, range);
  if (late_x.size() >= 3)
    list.difference("late_lateral_ratio", line_through(late_x, late_y).slope, range, last);
  return list.take();
}

std::vector<Feature> readings(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::aggregate);
  const auto strains = strains_up_to(kStrains, last_strain(observation));
  const auto lateral = read_at(columns.at("strain"), columns.at("lateral_strain"), strains, kHalf);
  for (std::size_t k = 0; k < strains.size(); ++k)
    list.difference(fmt::format("expansion_at_{:.2f}_percent", 100.0 * strains[k]), lateral[k], strains[k],
                    strains[k]);
  return list.take();
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  auto& lateral = columns["lateral_strain"];
  const std::vector<double> sigma =
      columns.contains("sigma")
          ? columns.at("sigma")
          : std::vector<double>(lateral.size(), curve_noise({columns.at("strain"), lateral}));
  add_noise(lateral, sigma, seed, kLasting);
  return columns;
}

Columns planned(const Observation&, const Sample&, double strain) {
  Columns columns;
  for (int row = 1; row * kPictures < strain * (1.0 + 1e-9); ++row) {
    columns["strain"].push_back(row * kPictures);
    columns["lateral_strain"].push_back(kRoughRatio * row * kPictures);
    columns["sigma"].push_back(kUsualError);
  }
  return columns;
}

Columns shown(const Observation& planned, const Columns& simulated) {
  Columns columns = planned.columns;
  columns["lateral_strain"] =
      read_at(simulated.at("strain"), simulated.at("lateral_strain"), columns["strain"], kHalf);
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  if (features.empty() || !features.front().name.starts_with("expansion"))
    return errors_by_name(features, {{"lateral_ratio", 0.02}, {"late_lateral_ratio", 0.06}});
  return errors_along(Eigen::VectorXd::Constant(static_cast<Eigen::Index>(features.size()), kError), kReach);
}

}  // namespace

/// Mean radial expansion at mid-height against platen strain, on first loading.
const Kind& kinds::lateral_strain() {
  static const Kind kind{
      .name = "lateral_strain",
      .required = {"strain", "lateral_strain"},
      .optional = {"sigma"},
      .least_rows = 4,
      .usual = UsualMeasurement{"lateral strain at mid-height",
                                "rearrangement and the ends show in it, a softer polymer does not", 0.3},
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
