#include "dem_core/run_result.h"

#include <nlohmann/json.hpp>

#include <algorithm>

#include "dem_core/observe/quasi_static.h"
#include "kinematics/local_strain.h"
#include "kinematics/shear_band.h"

namespace pendular::dem_core {
namespace {

constexpr double kUm = 1e6;  // µm per m

std::string mode(const BreakEvent& event) {
  const double normal = event.stretch * event.stretch, shear = event.shear * event.shear / 12.0;
  if (normal < 0.1 * (normal + shear)) return "shear";
  if (event.stretch < 0.0) return "compression";
  return shear < 0.1 * (normal + shear) ? "tension" : "mixed";
}

nlohmann::ordered_json features_json(const std::vector<CurveRow>& rows) {
  nlohmann::ordered_json json;
  const auto features = curve_features(rows);
  if (!features)
    return {{"linear_modulus_pa", nullptr},
            {"fit", nullptr},
            {"linear_limit_strain", nullptr},
            {"peak", nullptr}};
  json["linear_modulus_pa"] = {{"value", features->modulus}, {"sigma", features->modulus_sigma}};
  json["fit"] = {{"strain_range", {features->fit_from, features->fit_to}},
                 {"toe_strain", features->toe_strain}};
  json["linear_limit_strain"] =
      features->linear_limit ? nlohmann::ordered_json(*features->linear_limit) : nullptr;
  json["peak"] = {{"strain", features->peak_strain},
                  {"stress_pa", features->peak_stress},
                  {"passed", features->peak_passed}};
  return json;
}

nlohmann::ordered_json shear_band_json(const Simulation& simulation, double mean_diameter) {
  const auto strains =
      kinematics::local_strains(simulation.beads.start, simulation.beads.position, simulation.beads.radius);
  const std::vector<int> bonds = bead_contacts(simulation).bonds;
  std::vector<Vec3> positions;  // of beads that still belong to the specimen
  std::vector<double> shear;
  for (std::size_t k = 0; k < strains.size(); ++k) {
    if (bonds[k] == 0) continue;
    positions.push_back(simulation.beads.position[k]);
    shear.push_back(strains[k].shear);
  }
  if (positions.empty()) return {{"found", false}};
  const kinematics::ShearBand band = kinematics::find_shear_band(positions, shear, mean_diameter);
  return {{"found", band.found},
          {"normal", {band.normal.x(), band.normal.y(), band.normal.z()}},
          {"point_um", {kUm * band.point.x(), kUm * band.point.y(), kUm * band.point.z()}},
          {"angle_to_axis_deg", band.angle_to_axis * 180.0 / M_PI},
          {"thickness_um", kUm * band.thickness},
          {"contrast", band.contrast}};
}

nlohmann::ordered_json quasi_static_json(const std::vector<CurveRow>& rows) {
  const auto worst = quasi_static(rows);
  if (!worst) return nullptr;
  return {
      {"holds", worst->holds()},
      {"largest_inertial_number", worst->inertial_number},
      {"largest_unbalanced_force", worst->unbalanced_force},
      {"limits",
       {{"inertial_number", kQuasiStaticInertialNumber}, {"unbalanced_force", kQuasiStaticUnbalancedForce}}}};
}

/// Of a quasi-static test: its increments, and those that would not come to rest.
nlohmann::ordered_json relaxation_json(const std::vector<CurveRow>& rows,
                                       const Sample::Compression& compression) {
  const auto restless = std::count_if(rows.begin(), rows.end(), [&](const CurveRow& row) {
    return row.unbalanced_force > compression.relax_to;
  });
  return {{"increment", compression.relax_increment},
          {"rest", compression.relax_to},
          {"increments", rows.size()},
          {"not_at_rest", restless}};
}

nlohmann::ordered_json work_balance_json(const Simulation& simulation) {
  const Energies now = energies(simulation);
  const Work& work = simulation.work;
  const double found =
      now.elastic + now.kinetic + work.damped + work.slipped + work.broken + work.halted - work.given;
  return {{"platen_j", work.platen},
          {"elastic_j", now.elastic},
          {"kinetic_j", now.kinetic},
          {"damped_j", work.damped},
          {"slipped_j", work.slipped},
          {"released_by_breaking_j", work.broken},
          {"halted_j", work.halted},
          {"given_by_bonds_j", work.given},
          {"relative_error", work.platen != 0.0 ? (work.platen - found) / work.platen : 0.0}};
}

}  // namespace

std::vector<BreakRow> break_rows(const Simulation& simulation, const std::vector<std::int64_t>& bead_ids) {
  std::vector<BreakRow> rows;
  for (const auto& e : simulation.events)
    rows.push_back({e.strain, bead_ids[e.i], bead_ids[e.j], e.place, mode(e), e.stretch, e.shear, e.energy});
  return rows;
}

nlohmann::ordered_json result_json(const RunState& state, const Sample& sample,
                                   const Provenance& provenance) {
  const Simulation& simulation = state.simulation;
  nlohmann::ordered_json json = features_json(state.rows);
  json["shear_band"] = shear_band_json(simulation, sample.beads.diameter);
  json["work_balance"] = work_balance_json(simulation);
  json["quasi_static"] = quasi_static_json(state.rows);
  if (sample.compression.control == Control::relaxation)
    json["relaxation"] = relaxation_json(state.rows, sample.compression);
  json["broken_bonds"] = simulation.events.size();
  json["beads"] = simulation.beads.size();
  json["bonds"] = simulation.bonds.size();
  json["specimen"] = {{"height_um", kUm * simulation.initial_height},
                      {"section_mm2", 1e6 * simulation.section}};
  json["time_step_s"] = simulation.dt;
  json["steps"] = simulation.steps;
  json["platen_speed_mm_s"] = 1e3 * platen_speed(sample);
  json["final_strain"] = simulation.strain();
  json["provenance"] = to_json(provenance);
  return json;
}

}  // namespace pendular::dem_core
