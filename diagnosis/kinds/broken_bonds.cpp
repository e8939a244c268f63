#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"

namespace pendular::diagnosis {
namespace {

const std::vector<double> kStrains = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08,
                                      0.09, 0.10, 0.12, 0.14, 0.16, 0.20, 0.25, 0.30};
constexpr double kQuarter = 0.25;             // makes the root of a Poisson count of constant variance
constexpr int kUsualRows = 9;                 // of a count as it is usually kept
constexpr double kError = 0.5, kReach = 3.0;  // of the simulation, of a root

void check(const Sample&, Observation& observation, std::vector<std::string>&) {
  check_strain(observation, "strain");
  check_rising(observation, "strain");
  auto& count = observation.columns.at("count");
  const std::string file = observation.file.string();
  if (*std::min_element(count.begin(), count.end()) < 0.0)
    bad_input("{}: count: found {:.4g}, expected counts of events", file,
              *std::min_element(count.begin(), count.end()));
  if (observation.words.at("counts") == "per_interval") {
    std::partial_sum(count.begin(), count.end(), count.begin());
    observation.words["counts"] = "total";
  }
  for (std::size_t k = 1; k < count.size(); ++k)
    if (count[k] < count[k - 1])
      bad_input(
          "{}: count: found {:.6g} after {:.6g}, expected the running total since rest (counts = "
          "\"per_interval\" where each row counts its own)",
          file, count[k], count[k - 1]);
}

void course(const Observation& observation, Sample::Compression& course) {
  course.max_strain = std::max(course.max_strain, last_strain(observation));
}

Columns simulate(const Observation&, const Simulated& simulated) {
  return columns_of_rows(*simulated.test, "count", &CurveRow::broken_bonds);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::network);
  const auto &strain = columns.at("strain"), &count = columns.at("count");
  const double last = last_strain(observation);
  for (const auto& [name, share] : {std::pair("breaks_at_half", 0.5), {"breaks_at_end", 1.0}}) {
    double broken = 0.0;
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] <= share * last * (1.0 + 1e-9)) broken = std::max(broken, count[k]);
    list.ratio(name, broken + 1.0, 0.0, share * last);
  }
  return list.take();
}

/// A running total between rows by straight lines from no break at rest.
double total_at(const std::vector<double>& strain, const std::vector<double>& count, double at) {
  double x = 0.0, y = 0.0;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    if (strain[k] < x) continue;  // on the way of an unloading nothing breaks for the first time
    if (strain[k] >= at && strain[k] > x) return y + (count[k] - y) * (at - x) / (strain[k] - x);
    x = strain[k], y = count[k];
  }
  return at <= x * (1.0 + 1e-3) ? y : std::nan("");
}

std::vector<Feature> readings(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::network);
  for (double strain : strains_up_to(kStrains, last_strain(observation)))
    list.difference(fmt::format("root_breaks_at_{:.1f}_percent", 100.0 * strain),
                    std::sqrt(total_at(columns.at("strain"), columns.at("count"), strain) + kQuarter), strain,
                    strain);
  return list.take();
}

/// Counts rise from row to row: what is added between rows scatters.
Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  auto& count = columns["count"];
  double moved = 0.0, before = 0.0;
  for (std::size_t k = 0; k < count.size(); ++k) {
    const double more = std::max(0.0, count[k] - before);
    before = count[k];
    moved += std::max(0.0, more + std::sqrt(more) * random_normal(seed, k));
    count[k] = moved;
  }
  return columns;
}

Columns planned(const Observation&, const Sample&, double strain) {
  Columns columns;
  for (int row = 1; row <= kUsualRows; ++row) {
    columns["strain"].push_back(strain * row / kUsualRows);
    columns["count"].push_back(row);
  }
  return columns;
}

Columns shown(const Observation& planned, const Columns& simulated) {
  Columns columns = planned.columns;
  for (std::size_t k = 0; k < columns["strain"].size(); ++k)
    columns["count"][k] = total_at(simulated.at("strain"), simulated.at("count"), columns["strain"][k]);
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  if (features.empty() || !features.front().name.starts_with("root"))
    return errors_by_name(features, {{"breaks_at_half", 0.4}, {"breaks_at_end", 0.2}});
  return errors_along(Eigen::VectorXd::Constant(static_cast<Eigen::Index>(features.size()), kError), kReach);
}

}  // namespace

/// Broken bridges, or acoustic events, against platen strain: the running total since rest, or each row's own
/// (counts = "per_interval").
const Kind& kinds::broken_bonds() {
  static const Kind kind{.name = "broken_bonds",
                         .required = {"strain", "count"},
                         .least_rows = 2,
                         .scale = Scale::network,
                         .keys = {{"counts", {"total", "per_interval"}}},
                         .usual = UsualMeasurement{"acoustic events, or broken bridges, against strain",
                                                   "when bonds break, and how many", 0.3},
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
