#include "dem_core/run_folder.h"

#include <fmt/format.h>

#include "dem_core/local_strain.h"
#include "dem_core/quasi_static.h"
#include "dem_core/shear_band.h"
#include "dem_core/stress_field.h"
#include "packing/neighbours.h"
#include "packing/polydata.h"

namespace pendular {
namespace {

constexpr double kUm = 1e6;  // µm per m

std::string mode(const BreakEvent& event) {
  const double normal = event.stretch * event.stretch, shear = event.shear * event.shear / 12.0;
  if (normal < 0.1 * (normal + shear)) return "shear";
  if (event.stretch < 0.0) return "compression";
  return shear < 0.1 * (normal + shear) ? "tension" : "mixed";
}

std::vector<Vec3> in_um(const std::vector<Vec3>& points) {
  std::vector<Vec3> scaled;
  scaled.reserve(points.size());
  for (const auto& point : points) scaled.push_back(kUm * point);
  return scaled;
}

/// 1 where a pair pushes more than the mean of those that push, else 0.
std::vector<std::int64_t> force_chain(const std::vector<double>& force) {
  double sum = 0.0, count = 0.0;
  for (double f : force)
    if (f > 0.0) sum += f, count += 1.0;
  std::vector<std::int64_t> in_chain;
  for (double f : force) in_chain.push_back(f > 0.0 && f * count > sum);
  return in_chain;
}

/// Standing bonds, broken bonds and touching pairs without a bond, as lines.
void add_lines(PolyTable& table, const Simulation& simulation) {
  std::vector<double> force;
  std::vector<std::int64_t> state;
  const auto add = [&](int i, int j, double normal, int kind) {
    table.lines.push_back({i, j});
    force.push_back(normal);
    state.push_back(kind);
  };
  for (const auto& pair : simulation.pairs) {
    const double apart_by = gap(simulation, pair);
    if (pair.bond < 0 && apart_by > pair.properties.touch) continue;
    add(pair.i, pair.j, normal_force(apart_by, pair.properties, simulation.law), pair.bond >= 0 ? 0 : 2);
  }
  for (const auto& bond : simulation.bonds)
    if (bond.broken) add(bond.i, bond.j, 0.0, 1);
  table.line_data = {{"normal_force_n", force}, {"state", state}, {"force_chain", force_chain(force)}};
}

std::vector<double> damage(const Simulation& simulation) {
  std::vector<double> broken(simulation.beads.size()), all(simulation.beads.size());
  for (const auto& bond : simulation.bonds)
    for (int bead : {bond.i, bond.j}) {
      all[bead] += 1.0;
      if (bond.broken) broken[bead] += 1.0;
    }
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k] > 0.0) broken[k] /= all[k];
  return broken;
}

/// Counted anew: pairs that have come apart since may no longer be listed.
std::size_t pairs_touching_at_start(const BeadStates& beads, double tolerance) {
  std::vector<double> diameters;
  for (double radius : beads.radius) diameters.push_back(2.0 * radius);
  return pairs_within(beads.start, diameters, tolerance).size();
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
      local_strains(simulation.beads.start, simulation.beads.position, simulation.beads.radius);
  const std::vector<int> bonds = bead_contacts(simulation).bonds;
  std::vector<Vec3> positions;  // of beads that still belong to the specimen
  std::vector<double> shear;
  for (std::size_t k = 0; k < strains.size(); ++k) {
    if (bonds[k] == 0) continue;
    positions.push_back(simulation.beads.position[k]);
    shear.push_back(strains[k].shear);
  }
  if (positions.empty()) return {{"found", false}};
  const ShearBand band = find_shear_band(positions, shear, mean_diameter);
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

nlohmann::ordered_json work_balance_json(const Simulation& simulation) {
  const Energies now = energies(simulation);
  const Work& work = simulation.work;
  const double found = now.elastic + now.kinetic + work.damped + work.slipped + work.broken;
  return {{"platen_j", work.platen},
          {"elastic_j", now.elastic},
          {"kinetic_j", now.kinetic},
          {"damped_j", work.damped},
          {"slipped_j", work.slipped},
          {"released_by_breaking_j", work.broken},
          {"relative_error", work.platen != 0.0 ? (work.platen - found) / work.platen : 0.0}};
}

}  // namespace

void write_curve(const fs::path& path, const std::vector<CurveRow>& rows, const Provenance& provenance) {
  std::string text = to_comment(provenance);
  text +=
      "strain,stress_pa,stress_bottom_pa,broken_bonds,kinetic_energy_j,elastic_energy_j,platen_work_j,damped_"
      "j,"
      "slipped_j,released_by_breaking_j,bonds_per_bead,lateral_strain,inertial_number,unbalanced_force\n";
  for (const auto& r : rows)
    text += fmt::format(
        "{:.9g},{:.9g},{:.9g},{:.0f},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.9g},{:.6g},{:.6g}\n",
        r.strain, r.stress, r.stress_bottom, r.broken_bonds, r.kinetic, r.elastic, r.work, r.damped,
        r.slipped, r.released, r.coordination, r.lateral_strain, r.inertial_number, r.unbalanced_force);
  write_text(path, text);
}

void write_events(const fs::path& path, const Simulation& simulation,
                  const std::vector<std::int64_t>& bead_ids, const Provenance& provenance) {
  std::string text =
      to_comment(provenance) + "strain,bead_i,bead_j,x_um,y_um,z_um,mode,stretch_um,shear_um,energy_j\n";
  for (const auto& e : simulation.events)
    text += fmt::format("{:.9g},{},{},{:.4f},{:.4f},{:.4f},{},{:.6g},{:.6g},{:.6g}\n", e.strain,
                        bead_ids[e.i], bead_ids[e.j], kUm * e.place.x(), kUm * e.place.y(), kUm * e.place.z(),
                        mode(e), kUm * e.stretch, kUm * e.shear, e.energy);
  write_text(path, text);
}

void write_avalanches(const fs::path& path, const std::vector<Avalanche>& avalanches,
                      const Provenance& provenance) {
  std::string text =
      to_comment(provenance) + "first_strain,last_strain,breaks,energy_j,x_um,y_um,z_um,extent_um\n";
  for (const auto& a : avalanches)
    text += fmt::format("{:.9g},{:.9g},{},{:.6g},{:.4f},{:.4f},{:.4f},{:.4f}\n", a.first_strain,
                        a.last_strain, a.breaks, a.energy, kUm * a.centre.x(), kUm * a.centre.y(),
                        kUm * a.centre.z(), kUm * a.extent);
  write_text(path, text);
}

void write_frame(const fs::path& path, const Simulation& simulation,
                 const std::vector<std::int64_t>& bead_ids, double stress) {
  const auto& beads = simulation.beads;
  const std::size_t size = beads.size();
  std::vector<Vec3> displacement(size);
  std::vector<double> diameter(size), shear(size), volumetric(size), mean_stress(size), deviatoric(size);
  const auto strains = local_strains(beads.start, beads.position, beads.radius);
  const auto stresses =
      stress_field(simulation, forces(simulation), beads.position, stress_field_reach(simulation));
  for (std::size_t k = 0; k < size; ++k) {
    displacement[k] = kUm * (beads.position[k] - beads.start[k]);
    diameter[k] = kUm * 2.0 * beads.radius[k];
    shear[k] = strains[k].shear;
    volumetric[k] = strains[k].volumetric;
    mean_stress[k] = pressure(stresses[k]);
    deviatoric[k] = deviatoric_stress(stresses[k]);
  }
  const BeadContacts count = bead_contacts(simulation);
  PolyTable table;
  table.points = in_um(beads.position);
  table.point_data = {{"bead_id", bead_ids},
                      {"diameter_um", diameter},
                      {"displacement_um", displacement},
                      {"local_shear_strain", shear},
                      {"local_volumetric_strain", volumetric},
                      {"pressure_pa", mean_stress},
                      {"deviatoric_stress_pa", deviatoric},
                      {"coordination", std::vector<std::int64_t>(count.bonds.begin(), count.bonds.end())},
                      {"touching", std::vector<std::int64_t>(count.touching.begin(), count.touching.end())},
                      {"damage", damage(simulation)}};
  add_lines(table, simulation);
  table.number_fields = {{"strain", simulation.strain()},
                         {"stress_pa", stress},
                         {"platen_bottom_um", kUm * simulation.bottom.z},
                         {"platen_top_um", kUm * simulation.top.z},
                         {"specimen_diameter_um", kUm * std::sqrt(4.0 / M_PI * simulation.section)}};
  table.text_fields = {{"units", "coordinates in um; SI or the unit in an array's name otherwise"},
                       {"line_states", "0 bond, 1 broken bond, 2 contact without bond"}};
  write_polydata(path, table);
}

nlohmann::ordered_json result_json(const RunState& state, const Sample& sample,
                                   const Provenance& provenance) {
  const Simulation& simulation = state.simulation;
  const double mean_diameter = sample.beads.diameter;
  nlohmann::ordered_json json = features_json(state.rows);
  json["shear_band"] = shear_band_json(simulation, mean_diameter);
  json["work_balance"] = work_balance_json(simulation);
  json["quasi_static"] = quasi_static_json(state.rows);
  json["broken_bonds"] = simulation.events.size();
  json["beads"] = simulation.beads.size();
  json["bonds"] = simulation.bonds.size();
  json["pairs_touching_at_start"] = pairs_touching_at_start(simulation.beads, 1e-9 * mean_diameter);
  json["specimen"] = {{"height_um", kUm * simulation.initial_height},
                      {"section_mm2", 1e6 * simulation.section}};
  json["time_step_s"] = simulation.dt;
  json["steps"] = simulation.steps;
  json["platen_speed_mm_s"] = 1e3 * platen_speed(sample);
  json["final_strain"] = simulation.strain();
  json["provenance"] = to_json(provenance);
  return json;
}

}  // namespace pendular
