#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/error.h"
#include "base/line_fit.h"
#include "base/quantile.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/list.h"
#include "micromechanics/stiffness.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr double kSpreadOut = 1.2;                       // of necks, so that an exponent can be read
constexpr double kLeastRatio = 0.02, kMostRatio = 50.0;  // of measured stiffness over that by finite elements
constexpr double kNormalByGap = 0.82, kTangentialByGap = 0.44;  // −dln k/dln δ0 (docs/bridge.md)
// As they are usually measured: so many, of necks between these shares of the mean one, with this relative
// error.
constexpr int kUsualBridges = 20;
constexpr double kThinnest = 0.6, kThickest = 1.4, kUsualError = 0.08;
constexpr std::size_t kMostKept = 1024;  // tables of bridges whose stiffness is kept
constexpr int kQuantiles = 9;            // of the gaps in a specimen
constexpr double kLongest = 0.2;         // gap over bead diameter, as effects/bridge_gap_spread.cpp has it

/// Stiffness of bridges of a polymer of one pascal. Kept, because the runs of a diagnosis differ in E_p at
/// most, and all ask for the same bridges.
std::vector<micromechanics::BondStiffness> stiffness_per_pascal(
    const std::vector<micromechanics::BridgeBody>& bodies, double poisson_ratio) {
  static std::mutex guard;
  static std::map<std::vector<double>, std::vector<micromechanics::BondStiffness>> kept;
  std::vector<double> key = {poisson_ratio};
  for (const auto& body : bodies)
    key.insert(key.end(), {body.neck_diameter, body.gap, body.diameter_i, body.diameter_j});
  const std::lock_guard lock(guard);
  if (kept.size() == kMostKept && !kept.contains(key)) kept.clear();
  auto& found = kept[key];
  // Isolated: a thread that waits for its loops would otherwise take up another run, which asks for the lock.
  if (found.empty())
    found = tbb::this_task_arena::isolate([&] {
      return micromechanics::bridge_stiffnesses(bodies, {1.0, poisson_ratio}).bonds;
    });
  return found;
}

/// What normal and tangential stiffness are over those by finite elements: one where none is stated.
std::pair<double, double> stated_over_finite_elements(const Sample& sample) {
  const auto& bridges = sample.bridges;
  if (!bridges.normal_stiffness) return {1.0, 1.0};
  const micromechanics::BondStiffness mean =
      stiffness_per_pascal({micromechanics::mean_bridge(sample)}, bridges.poisson_ratio).front();
  return {*bridges.normal_stiffness / (bridges.youngs_modulus * mean.normal),
          *bridges.tangential_stiffness / (bridges.youngs_modulus * mean.tangential)};
}

/// The stiffness of the tested bridges at one gap, m.
Columns at_gap(const Observation& observation, const Sample& sample, double gap) {
  const auto &d = observation.column("d_um"), &diameter = observation.column("D_um");
  std::vector<micromechanics::BridgeBody> bodies;
  for (std::size_t k = 0; k < d.size(); ++k)
    bodies.push_back({d[k] / kUm, gap, diameter[k] / kUm, diameter[k] / kUm});
  const auto [normal, tangential] = stated_over_finite_elements(sample);
  const double modulus = sample.bridges.youngs_modulus;
  Columns columns = {{"d_um", d}, {"D_um", diameter}};
  for (const auto& bond : stiffness_per_pascal(bodies, sample.bridges.poisson_ratio)) {
    columns["kn_n_per_m"].push_back(normal * modulus * bond.normal);
    columns["kt_n_per_m"].push_back(tangential * modulus * bond.tangential);
  }
  return columns;
}

/// Bridges cut from the specimen have its gaps: the mean logarithm over their distribution.
Columns of_specimen(const Observation& observation, const Sample& sample) {
  const double spread = effects::spread_of_bridges(sample).gap_excess / kUm, least = sample.bridges.gap;
  Columns sum = at_gap(observation, sample, least);
  if (spread <= 0.0) return sum;
  for (const char* name : {"kn_n_per_m", "kt_n_per_m"}) std::fill(sum[name].begin(), sum[name].end(), 0.0);
  for (int q = 0; q < kQuantiles; ++q) {
    const double excess = -spread * std::log(1.0 - (q + 0.5) / kQuantiles);
    const Columns one = at_gap(observation, sample,
                               std::min(least + excess, std::max(least, kLongest * sample.beads.diameter)));
    for (const char* name : {"kn_n_per_m", "kt_n_per_m"})
      for (std::size_t k = 0; k < one.at(name).size(); ++k)
        sum[name][k] += std::log(one.at(name)[k]) / kQuantiles;
  }
  for (const char* name : {"kn_n_per_m", "kt_n_per_m"})
    for (double& value : sum[name]) value = std::exp(value);
  return sum;
}

double gap_of(const Observation& observation, const Sample& sample) {
  const double stated = observation.numbers.at("gap_um");
  return stated > 0.0 ? stated / kUm : sample.bridges.gap;
}

Columns simulate(const Observation& observation, const Simulated& simulated) {
  if (observation.words.at("origin") == "specimen") return of_specimen(observation, simulated.sample);
  return at_gap(observation, simulated.sample, gap_of(observation, simulated.sample));
}

/// One row in another unit than the others is off by a power of a thousand.
void check_rows(const Observation& observation, const std::string& column,
                const std::vector<double>& values) {
  constexpr double kApart = 200.0;
  const double middle = median(values);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] < middle / kApart || values[k] > middle * kApart)
      bad_input(
          "{}: {}: row {}: found {:.3g}, {:.2g} times the median of the column's rows; expected one unit in "
          "all",
          observation.file.string(), column, k + 1, observation.column(column)[k], values[k] / middle);
}

/// A stiffness that is a power of a thousand off is in another unit.
void check_unit(const Sample& believed, const Observation& observation) {
  const Columns expected = at_gap(observation, believed, gap_of(observation, believed));
  for (const char* name : {"kn_n_per_m", "kt_n_per_m"}) {
    if (!observation.has(name)) continue;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < observation.rows(); ++k)
      ratios.push_back(observation.column(name)[k] / expected.at(name)[k]);
    const double ratio = median(ratios);
    check_rows(observation, name, ratios);
    if (ratio > kLeastRatio && ratio < kMostRatio) continue;
    const auto fits = [&](double factor) {
      return ratio * factor > kLeastRatio && ratio * factor < kMostRatio;
    };
    const char* unit = fits(1e3)    ? "; in kN/m or N/mm it would fit"
                       : fits(1e-3) ? "; in mN/m it would fit"
                       : fits(1e6)  ? "; in MN/m or N/um it would fit"
                       : fits(1e-6) ? "; in uN/m it would fit"
                                    : "";
    bad_input(
        "{}: {}: found {:.3g} times what finite elements give for these bridges (median), expected about "
        "one{}",
        observation.file.string(), name, ratio, unit);
  }
}

void check(const Sample& believed, Observation& observation, std::vector<std::string>&) {
  const std::string file = observation.file.string();
  for (const char* stiffness : {"kn", "kt"}) {
    const std::string value = std::string(stiffness) + "_n_per_m",
                      sigma = std::string(stiffness) + "_sigma_n_per_m";
    if (observation.has(value) != observation.has(sigma))
      bad_input("{}: found {} without {}, expected both or neither", file,
                observation.has(value) ? value : sigma, observation.has(value) ? sigma : value);
  }
  if (!observation.has("kn_n_per_m") && !observation.has("kt_n_per_m"))
    bad_input("{}: found neither kn_n_per_m nor kt_n_per_m, expected at least one", file);
  for (const auto& [name, column] : observation.columns)
    if (!name.ends_with("sigma_n_per_m") && *std::min_element(column.begin(), column.end()) <= 0.0)
      bad_input("{}: {}: found {:.4g}, expected positive values", file, name,
                *std::min_element(column.begin(), column.end()));
  const auto &d = observation.column("d_um"), &diameter = observation.column("D_um");
  // Micropipette tests use larger beads than the specimen's; a millimetre is off by far more.
  const double beads = kUm * believed.beads.diameter;
  check_length(observation, "D_um", 0.05 * beads, 20.0 * beads);
  check_length(observation, "d_um", 0.01 * median(diameter), median(diameter));
  check_rows(observation, "D_um", diameter);
  check_rows(observation, "d_um", d);
  for (std::size_t k = 0; k < d.size(); ++k)
    if (d[k] >= diameter[k])
      bad_input("{}: found a bridge of {:.4g} um on beads of {:.4g} um, expected it to be thinner", file,
                d[k], diameter[k]);
  for (const char* stiffness : {"kn", "kt"})
    if (const std::string name = stiffness; observation.has(name + "_n_per_m"))
      check_sigma(observation, name + "_sigma_n_per_m", largest_of(observation.column(name + "_n_per_m")));
  check_unit(believed, observation);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::bridge);
  const auto& d = columns.at("d_um");
  const auto [least, most] = std::minmax_element(d.begin(), d.end());
  for (const char* stiffness : {"kn", "kt"}) {
    const std::string name = std::string(stiffness) + "_n_per_m";
    if (!observation.has(name)) continue;
    const auto logs = logarithms_of(columns.at(name));
    list.ratio(std::string(stiffness) + "_level", std::exp(mean_of(logs)));
    if (logs.size() >= 4 && *most > kSpreadOut * *least)
      list.difference(std::string(stiffness) + "_exponent", line_through(logarithms_of(d), logs).slope);
  }
  return list.take();
}

/// Errors of the gap at which bridges were made are those of all tests of a table.
Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  add_stated_noise(columns, "kn_n_per_m", "kn_sigma_n_per_m", seed);
  add_stated_noise(columns, "kt_n_per_m", "kt_sigma_n_per_m", seed + 0x10000);
  const double gap = observation.numbers.at("gap_um"), sigma = observation.numbers.at("gap_sigma_um");
  if (gap <= 0.0 || sigma <= 0.0) return columns;
  std::vector<double> off = {0.0};
  add_noise(off, {sigma / gap}, seed + 0x20000);
  for (const auto& [name, power] : {std::pair("kn_n_per_m", kNormalByGap), {"kt_n_per_m", kTangentialByGap}})
    if (columns.contains(name))
      for (double& value : columns[name]) value *= std::exp(-power * off.front());
  return columns;
}

/// Necks over a range about the mean one, on beads of the mean size.
Columns planned(const Observation&, const Sample& believed, double) {
  Columns columns;
  for (int k = 0; k < kUsualBridges; ++k) {
    const double share = kThinnest + (kThickest - kThinnest) * k / (kUsualBridges - 1);
    columns["d_um"].push_back(kUm * share * believed.bridges.diameter);
    columns["D_um"].push_back(kUm * believed.beads.diameter);
    for (const char* name : {"kn_n_per_m", "kn_sigma_n_per_m", "kt_n_per_m", "kt_sigma_n_per_m"})
      columns[name].push_back(1.0);
  }
  return columns;
}

Columns shown(const Observation& planned, const Columns& simulated) {
  Columns columns = planned.columns;
  for (const std::string stiffness : {"kn", "kt"}) {
    columns[stiffness + "_n_per_m"] = simulated.at(stiffness + "_n_per_m");
    auto& sigma = columns[stiffness + "_sigma_n_per_m"] = simulated.at(stiffness + "_n_per_m");
    for (double& one : sigma) one *= kUsualError;
  }
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(
      features, {{"kn_level", 0.02}, {"kt_level", 0.02}, {"kn_exponent", 0.05}, {"kt_exponent", 0.05}});
}

}  // namespace

/// Single-bridge tests. Simulated by finite elements from each bridge's own diameter, scaled to the stated
/// stiffness where one is stated: at the gap at which they were made (origin = "made"; gap_um, the sample's
/// where it is not stated, within gap_sigma_um), or with the specimen's gaps (origin = "specimen").
const Kind& kinds::bridge_stiffness() {
  static const Kind kind{
      .name = "bridge_stiffness",
      .required = {"d_um", "D_um"},
      .optional = {"kn_n_per_m", "kn_sigma_n_per_m", "kt_n_per_m", "kt_sigma_n_per_m"},
      .scale = Scale::bridge,
      .keys = {{"origin", {"made", "specimen"}},
               {"gap_um", {}, 0.0, 1e3, 0.0},
               {"gap_sigma_um", {}, 0.0, 1e3, 0.0}},
      .usual = UsualMeasurement{"twenty single bridges by micropipettes",
                                "stiffness and course of a bridge without the network", 1.0},
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
