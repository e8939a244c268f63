#include "blind/engine_run.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/path_kind.h"
#include "dem_core/bond_bodies.h"
#include "dem_core/simulation.h"
#include "effects/list.h"
#include "micromechanics/stiffness.h"

namespace pendular::blind {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// The table of stiffness: gaps from the stated one to the longest that an effect makes, necks likewise.
constexpr std::size_t kGaps = 12, kNecks = 13;
constexpr double kLongest = 0.2, kThickest = 0.8;  // over D
constexpr double kThinnest = 0.2;                  // over d

ordered_json vectors_json(const std::vector<Bead>& beads) {
  ordered_json list = ordered_json::array();
  for (const auto& bead : beads) list.push_back({bead.centre.x(), bead.centre.y(), bead.centre.z()});
  return list;
}

ordered_json law_json(const Sample& sample) {
  const micromechanics::BondStiffness bond = micromechanics::bond_stiffness(sample);
  const double ratio = sample.contact.stiffness_ratio;
  return {{"kn_n_per_m", bond.normal},
          {"kt_n_per_m", bond.tangential},
          {"k_bend_n_m_per_rad", bond.bending},
          {"k_twist_n_m_per_rad", bond.twisting},
          {"k_glass_n_per_m", ratio * bond.normal},
          {"kt_glass_n_per_m", ratio * bond.tangential},
          {"friction", sample.contact.friction},
          {"platen_friction", sample.contact.platen_friction},
          {"density_kg_m3", sample.beads.density},
          {"diameter_m", sample.beads.diameter},
          {"gap_m", sample.bridges.gap},
          {"interfacial_energy_j_m2", sample.bridges.interfacial_energy},
          {"youngs_modulus_pa", sample.bridges.youngs_modulus}};
}

/// Stiffness of bridges over that of the mean one, where no effect changes their bodies.
ordered_json flat_stiffness(const micromechanics::BridgeBody& mean) {
  const ordered_json ones = {{1.0, 1.0}, {1.0, 1.0}};
  return {{"gap_m", {mean.gap, 2.0 * mean.gap}},
          {"neck_m", {0.5 * mean.neck_diameter, mean.neck_diameter}},
          {"normal", ones},
          {"tangential", ones},
          {"bending", ones},
          {"twisting", ones}};
}

/// Likewise, rows by gap, columns by neck; by finite elements where some effect does.
ordered_json stiffness_json(const Sample& sample) {
  const micromechanics::BridgeBody mean = micromechanics::mean_bridge(sample);
  const bool changed = std::any_of(sample.effects.begin(), sample.effects.end(), [](const auto& item) {
    return effects::find_effect(item.first, "engine").body != nullptr;
  });
  if (!changed) return flat_stiffness(mean);
  const double longest = std::max(kLongest * sample.beads.diameter, 1.1 * mean.gap);
  const double thinnest = kThinnest * mean.neck_diameter, thickest = kThickest * sample.beads.diameter;
  ordered_json gaps = ordered_json::array(), necks = ordered_json::array();
  std::vector<micromechanics::BridgeBody> bodies = {mean};
  for (std::size_t g = 0; g < kGaps; ++g)
    gaps.push_back(mean.gap * std::pow(longest / mean.gap, static_cast<double>(g) / (kGaps - 1)));
  for (std::size_t n = 0; n < kNecks; ++n)
    necks.push_back(thinnest + (thickest - thinnest) * static_cast<double>(n) / (kNecks - 1));
  for (const auto& gap : gaps)
    for (const auto& neck : necks)
      bodies.push_back({neck.get<double>(), gap.get<double>(), mean.diameter_i, mean.diameter_j});
  const auto bonds = micromechanics::bridge_stiffnesses(bodies, micromechanics::polymer_of(sample)).bonds;
  ordered_json table{{"gap_m", gaps}, {"neck_m", necks}};
  const auto add = [&](const char* name, double micromechanics::BondStiffness::*which) {
    for (std::size_t g = 0; g < kGaps; ++g) {
      ordered_json row = ordered_json::array();
      for (std::size_t n = 0; n < kNecks; ++n)
        row.push_back(bonds[1 + g * kNecks + n].*which / (bonds[0].*which));
      table[name].push_back(row);
    }
  };
  add("normal", &micromechanics::BondStiffness::normal);
  add("tangential", &micromechanics::BondStiffness::tangential);
  add("bending", &micromechanics::BondStiffness::bending);
  add("twisting", &micromechanics::BondStiffness::twisting);
  return table;
}

ordered_json bridges_json(const Packing& packing, const Sample& sample) {
  const auto standing = dem_core::standing_bridges(packing);
  const auto bodies = dem_core::bond_bodies(packing, standing, sample);
  ordered_json pairs = ordered_json::array(), necks = ordered_json::array();
  for (std::size_t k = 0; k < standing.size(); ++k) {
    pairs.push_back({standing[k].i, standing[k].j});
    necks.push_back(bodies[k].neck_diameter);
  }
  return {{"pairs", pairs}, {"neck_m", necks}};
}

ordered_json test_json(const EngineRun& run) {
  const Sample& sample = run.sample;
  ordered_json test{{"speed_m_per_s", dem_core::platen_speed(sample)},
                    {"max_strain", run.max_strain},
                    {"unload_at", run.unload_at},
                    {"frame_at", run.frame_at},
                    {"rows_per_strain", sample.compression.rows_per_strain},
                    {"section_m2", 0.25 * M_PI * sample.specimen.diameter * sample.specimen.diameter},
                    {"height_m", sample.specimen.height},
                    {"axis_x_m", run.packing.specimen.axis_x},
                    {"axis_y_m", run.packing.specimen.axis_y},
                    {"relaxation_time_s", nullptr}};
  if (sample.bridges.relaxation_time) test["relaxation_time_s"] = *sample.bridges.relaxation_time;
  return test;
}

/// A number of a result, which writes what is none as null or NaN.
double number(const json& value, const char* what) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw ComputationFailed(fmt::format("{}: found {}, expected a number", what, value.dump()));
  return value.get<double>();
}

std::vector<std::pair<int, int>> pairs_of(const json& list, std::size_t beads, const char* what) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& pair : list) {
    const int i = pair.at(0).get<int>(), j = pair.at(1).get<int>();
    if (i < 0 || j <= i || j >= static_cast<int>(beads))
      throw ComputationFailed(fmt::format(
          "{}: found beads {} and {}, expected two of {}, the first one first", what, i, j, beads));
    pairs.emplace_back(i, j);
  }
  return pairs;
}

std::vector<double> numbers_of(const json& list, std::size_t count, const char* what) {
  std::vector<double> values;
  for (const auto& value : list) values.push_back(number(value, what));
  if (values.size() != count)
    throw ComputationFailed(fmt::format("{}: found {} numbers, expected {}", what, values.size(), count));
  return values;
}

EngineFrame frame_of(const json& read, std::size_t beads) {
  EngineFrame frame;
  frame.strain = number(read.at("strain"), "frames.strain");
  for (const auto& moved : read.at("displacement_m")) {
    const auto xyz = numbers_of(moved, 3, "frames.displacement_m");
    frame.displacement.emplace_back(xyz[0], xyz[1], xyz[2]);
  }
  if (frame.displacement.size() != beads)
    throw ComputationFailed(
        fmt::format("frames.displacement_m: found {} beads, expected {}", frame.displacement.size(), beads));
  frame.bonds = pairs_of(read.at("bonds"), beads, "frames.bonds");
  frame.touching = pairs_of(read.at("touching"), beads, "frames.touching");
  return frame;
}

std::vector<CurveRow> rows_of(const json& list) {
  constexpr std::size_t kColumns = 5;
  std::vector<CurveRow> rows;
  for (const auto& read : list) {
    const auto values = numbers_of(read, kColumns, "rows");
    CurveRow row;
    row.strain = values[0], row.stress = values[1], row.stress_bottom = values[2];
    row.broken_bonds = values[3], row.lateral_strain = values[4];
    rows.push_back(row);
  }
  return rows;
}

EngineResult result_of(const json& read, std::size_t beads, std::size_t frames) {
  EngineResult result;
  result.engine = read.at("engine").get<std::string>();
  if (read.at("beads").get<std::size_t>() != beads)
    throw ComputationFailed(
        fmt::format("beads: found {}, expected {}", read.at("beads").get<std::size_t>(), beads));
  const json& bridges = read.at("bridges");
  result.bonds = pairs_of(bridges.at("pairs"), beads, "bridges.pairs");
  result.gap = numbers_of(bridges.at("gap_m"), result.bonds.size(), "bridges.gap_m");
  result.neck = numbers_of(bridges.at("neck_m"), result.bonds.size(), "bridges.neck_m");
  result.rows = rows_of(read.at("rows"));
  for (const auto& frame : read.at("frames")) result.frames.push_back(frame_of(frame, beads));
  if (result.frames.size() != frames)
    throw ComputationFailed(fmt::format("frames: found {}, expected {}", result.frames.size(), frames));
  for (const auto& event : read.at("events")) result.breaks.push_back(number(event.at(0), "events"));
  return result;
}

}  // namespace

std::string run_text(const EngineRun& run) {
  if (run.sample.bridges.stiffness != StiffnessOf::one)
    bad_input("engine {}: found bridges.stiffness = \"{}\", expected \"one\"", run.engine.name,
              to_string(run.sample.bridges.stiffness));
  ordered_json effects = ordered_json::object();
  for (const auto& [id, theta] : run.sample.effects) effects[id] = theta;
  ordered_json diameters = ordered_json::array();
  for (const auto& bead : run.packing.beads) diameters.push_back(bead.diameter);
  const ordered_json text{
      {"engine",
       {{"glass", run.engine.glass},
        {"breaking", run.engine.breaking},
        {"local_damping", run.engine.local_damping}}},
      {"seed", run.seed},
      {"effects", effects},
      {"law", law_json(run.sample)},
      {"test", test_json(run)},
      {"stiffness", stiffness_json(run.sample)},
      {"beads", {{"centre_m", vectors_json(run.packing.beads)}, {"diameter_m", diameters}}},
      {"bridges", bridges_json(run.packing, run.sample)}};
  return text.dump(1) + "\n";
}

EngineResult read_result(const fs::path& path, std::size_t beads, std::size_t frames) {
  const auto failed = [&](const std::string& why) {
    return ComputationFailed(fmt::format("{}: {}", path.string(), why));
  };
  if (!is_there(path)) throw failed("found no file, expected the engine's result");
  const auto read = json::parse(read_text(path), nullptr, false);
  if (read.is_discarded()) throw failed("found text that is not JSON, or a number that is none");
  try {
    return result_of(read, beads, frames);
  } catch (const json::exception& error) {
    throw failed(error.what());
  } catch (const ComputationFailed& error) {
    throw failed(error.what());
  }
}

}  // namespace pendular::blind
