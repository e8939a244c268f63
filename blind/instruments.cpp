#include "blind/instruments.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "base/error.h"
#include "blind/logger.h"
#include "blind/noise.h"
#include "dem_core/bond_bodies.h"
#include "micromechanics/stiffness.h"
#include "packing/statistics.h"

namespace pendular::blind {
namespace {

constexpr double kLoggerStep = 5e-4;      // strain between rows of a curve
constexpr double kForceNoise = 0.003;     // over the largest force
constexpr double kCorrelatedShare = 0.5;  // of the noise's variance
constexpr double kCorrelation = 0.7;      // from row to row
constexpr double kGainError = 0.005;
constexpr double kLateralNoise = 2e-4;
constexpr double kCoordinationNoise = 0.05;
constexpr double kGapNoise = 0.5, kNeckNoise = 1.5;  // um
constexpr double kBridgeNoise = 0.08;                // of a single bridge's stiffness
constexpr std::size_t kGaps = 60, kNecks = 60, kSingleBridges = 20;
constexpr double kThinnest = 0.6, kThickest = 1.4;  // of the bridges that are tested, over d
constexpr double um = 1e-6;

/// One after the other, of unit variance: white and a part that lasts over some rows.
class CorrelatedNoise {
 public:
  explicit CorrelatedNoise(Noise& noise) : noise_(noise), last_(noise.normal()) {}
  double next() {
    last_ = kCorrelation * last_ + std::sqrt(1.0 - kCorrelation * kCorrelation) * noise_.normal();
    return std::sqrt(kCorrelatedShare) * last_ + std::sqrt(1.0 - kCorrelatedShare) * noise_.normal();
  }

 private:
  Noise& noise_;
  double last_;
};

/// What is observed of one case, one kind after the other.
class Laboratory {
 public:
  Laboratory(const CasePlan& plan, const Split& split, nlohmann::ordered_json& told)
      : plan_(plan), split_(split), told_(told) {}

  std::vector<CurveRow> rows_of(const TrueTest& test) const {
    auto rows = logged(test.rows, kLoggerStep, split_.max_strain);
    if (rows.size() < 16)
      throw ComputationFailed(
          fmt::format("{}: found {} rows of a curve, expected at least 16", plan_.name, rows.size()));
    return rows;
  }

  Table compression(const std::string& name, const TrueTest& test) {
    Noise noise(plan_.seed, "load cell " + name);
    const auto rows = rows_of(test);
    double highest = 0.0;
    for (const auto& row : rows) highest = std::max(highest, row.stress);
    const double gain = 1.0 + noise.between(-kGainError, kGainError), sigma = kForceNoise * highest;
    const double misjudged = noise.misjudged();
    const bool stated = noise.between(0.0, 1.0) < 0.8;
    CorrelatedNoise cell(noise);
    Table table{{"strain", "stress_pa"}, {}};
    if (stated) table.names.emplace_back("stress_sigma_pa");
    for (const auto& row : rows) {
      table.rows.push_back({row.strain, gain * row.stress + sigma * cell.next()});
      if (stated) table.rows.back().push_back(misjudged * sigma);
    }
    told_[name] = {{"gain", gain}, {"sigma_pa", sigma}, {"stated_over_true_sigma", stated ? misjudged : 0.0}};
    return table;
  }

  Table lateral(const TrueTest& test) {
    Noise noise(plan_.seed, "lateral");
    const double misjudged = noise.misjudged();
    CorrelatedNoise camera(noise);
    Table table{{"strain", "lateral_strain", "sigma"}, {}};
    const auto rows = first_loading(rows_of(test));
    for (std::size_t k = 3; k < rows.size(); k += 4)
      table.rows.push_back({rows[k].strain, rows[k].lateral_strain + kLateralNoise * camera.next(),
                            misjudged * kLateralNoise});
    told_["lateral_strain"] = {{"sigma", kLateralNoise}, {"stated_over_true_sigma", misjudged}};
    return table;
  }

  /// Counted breaks, of which a few are not heard.
  Table breaks(const TrueTest& test) {
    Noise noise(plan_.seed, "breaks");
    const double heard = noise.between(0.96, 1.0);
    Table table{{"strain", "count"}, {}};
    const auto rows = first_loading(rows_of(test));
    const auto every = std::max<std::size_t>(1, rows.size() / 9);
    for (std::size_t k = every - 1; k < rows.size(); k += every)
      table.rows.push_back({rows[k].strain, std::max(0.0, std::round(heard * rows[k].broken_bonds))});
    told_["broken_bonds"] = {{"heard", heard}};
    return table;
  }

  Table coordination_of(const TrueTest& test) {
    Noise noise(plan_.seed, "coordination");
    const double misjudged = noise.misjudged();
    std::vector<Bridge> seen = test.packing.bridges;
    std::erase_if(seen, [](const Bridge& bridge) { return bridge.state != BridgeState::candidate; });
    const double z = coordination(test.packing.beads, seen).mean;
    told_["coordination"] = {
        {"true", z}, {"sigma", kCoordinationNoise}, {"stated_over_true_sigma", misjudged}};
    return {{"z", "z_sigma"}, {{z + kCoordinationNoise * noise.normal(), misjudged * kCoordinationNoise}}};
  }

  Table gaps(const TrueTest& test) {
    Noise noise(plan_.seed, "gaps");
    const double misjudged = noise.misjudged();
    Table table{{"gap_um", "sigma_um"}, {}};
    for (const auto& body : drawn(test, kGaps, noise))
      table.rows.push_back({body.gap / um + kGapNoise * noise.normal(), misjudged * kGapNoise});
    told_["bridge_gaps"] = {{"sigma_um", kGapNoise}, {"stated_over_true_sigma", misjudged}};
    return table;
  }

  Table necks(const TrueTest& test) {
    Noise noise(plan_.seed, "necks");
    Table table{{"d_um"}, {}};
    for (const auto& body : drawn(test, kNecks, noise))
      table.rows.push_back({std::max(1.0, body.neck_diameter / um + kNeckNoise * noise.normal())});
    told_["bridge_diameters"] = {{"sigma_um", kNeckNoise}};
    return table;
  }

  /// Bridges made one by one of the specimen's polymer, at the gap for which the stiffness is stated.
  Table single_bridges(const TrueTest& test) {
    Noise noise(plan_.seed, "single bridges");
    const double misjudged = noise.misjudged();
    const auto& beads = test.sample.beads;
    const auto& bridges = test.sample.bridges;
    std::vector<micromechanics::BridgeBody> bodies;
    for (std::size_t k = 0; k < kSingleBridges; ++k) {
      const double diameter = beads.diameter + beads.diameter_sd * noise.normal();
      bodies.push_back(
          {noise.between(kThinnest, kThickest) * bridges.diameter, bridges.gap, diameter, diameter});
    }
    const auto stiffness =
        micromechanics::bridge_stiffnesses(bodies, micromechanics::polymer_of(test.sample)).bonds;
    Table table{{"d_um", "D_um", "kn_n_per_m", "kn_sigma_n_per_m", "kt_n_per_m", "kt_sigma_n_per_m"}, {}};
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const double kn = stiffness[k].normal * std::exp(kBridgeNoise * noise.normal());
      const double kt = stiffness[k].tangential * std::exp(kBridgeNoise * noise.normal());
      const double stated = misjudged * kBridgeNoise;
      table.rows.push_back(
          {bodies[k].neck_diameter / um, bodies[k].diameter_i / um, kn, stated * kn, kt, stated * kt});
    }
    told_["bridge_stiffness"] = {{"relative_sigma", kBridgeNoise}, {"stated_over_true_sigma", misjudged}};
    return table;
  }

 private:
  /// Some of the specimen's bridges.
  static std::vector<micromechanics::BridgeBody> drawn(const TrueTest& test, std::size_t count,
                                                       Noise& noise) {
    const auto standing = dem_core::standing_bridges(test.packing);
    std::vector<micromechanics::BridgeBody> bodies;
    while (bodies.size() < count) {
      const std::size_t k = noise.below(test.bodies.size());
      if (standing[k].state == BridgeState::candidate) bodies.push_back(test.bodies[k]);
    }
    return bodies;
  }

  const CasePlan& plan_;
  const Split& split_;
  nlohmann::ordered_json& told_;
};

}  // namespace

std::string csv_text(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.names, ","));
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const double value : row) cells.push_back(csv_cell(value, 6));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

Tables observe(const CasePlan& plan, const Split& split, const TrueTest& a, const TrueTest* b,
               nlohmann::ordered_json& noise) {
  Laboratory laboratory(plan, split, noise);
  Tables tables;
  tables["A"] = laboratory.compression("A", a);
  if (b) tables["B"] = laboratory.compression("B", *b);
  for (const auto& kind : plan.kinds) {
    if (kind == "lateral_strain") tables[kind] = laboratory.lateral(a);
    if (kind == "broken_bonds") tables[kind] = laboratory.breaks(a);
    if (kind == "coordination") tables[kind] = laboratory.coordination_of(a);
    if (kind == "bridge_gaps") tables[kind] = laboratory.gaps(a);
    if (kind == "bridge_diameters") tables[kind] = laboratory.necks(a);
    if (kind == "bridge_stiffness") tables[kind] = laboratory.single_bridges(a);
  }
  return tables;
}

}  // namespace pendular::blind
