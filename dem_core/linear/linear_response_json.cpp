#include "dem_core/linear/linear_response_json.h"

#include <nlohmann/json.hpp>

namespace pendular::dem_core {
namespace {

nlohmann::ordered_json to_json(const ContactCount& count) {
  return {{"bonds", count.bonds},
          {"touching_pairs", count.touching},
          {"beads_on_bottom_platen", count.bottom},
          {"beads_on_top_platen", count.top},
          {"sliding", count.sliding},
          {"breaking_bonds", count.breaking}};
}

}  // namespace

nlohmann::ordered_json to_json(const LinearResponse& response, const Simulation& simulation, double strain) {
  return {
      {"linear_modulus_pa", response.modulus},
      {"poisson_ratio", response.poisson_ratio},
      {"strain", strain},
      {"stress_pa", response.stress},
      {"contacts", to_json(response.contacts)},
      {"holds", response.holds()},
      {"reasons", response.reasons},
      {"effect_on_modulus", {{"sliding", response.sliding_effect}, {"carried_load", response.load_effect}}},
      {"search", {{"rounds", response.rounds}, {"unsettled_contacts", response.unsettled}}},
      {"solver", {{"iterations", response.iterations}, {"residual", response.residual}}},
      {"beads", simulation.beads.size()},
      {"specimen",
       {{"height_um", 1e6 * simulation.initial_height}, {"section_mm2", 1e6 * simulation.section}}}};
}

}  // namespace pendular::dem_core
