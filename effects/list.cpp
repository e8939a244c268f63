#include "effects/list.h"

#include "base/error.h"
#include "base/nearest.h"

namespace pendular::effects {

// One line each; its file has the same name.
#define PENDULAR_EFFECTS(effect)                                                                             \
  effect(bridge_gap_spread) effect(bridge_diameter_spread) effect(missing_bridges) effect(bridge_bending)    \
      effect(polymer_nonlinearity) effect(polymer_viscoelasticity) effect(bond_damage)                       \
          effect(interface_strength) effect(residual_stress) effect(bead_friction) effect(platen_friction)   \
              effect(platen_tilt) effect(platen_roughness) effect(machine_compliance)                        \
                  effect(funicular_bridges) effect(position_error) effect(diameter_bias) effect(voxel_scale) \
                      effect(loading_rate)

#define PENDULAR_DECLARE(id) Effect id();
#define PENDULAR_CALL(id) id(),
PENDULAR_EFFECTS(PENDULAR_DECLARE)

const std::vector<Effect>& all_effects() {
  static const std::vector<Effect> effects = {PENDULAR_EFFECTS(PENDULAR_CALL)};
  return effects;
}

const Effect& find_effect(const std::string& id, const std::string& where) {
  std::vector<std::string> ids;
  for (const auto& effect : all_effects()) {
    if (effect.id == id) return effect;
    ids.push_back(effect.id);
  }
  bad_input("{}: effects.{}: unknown effect, the nearest known one is \"{}\"", where, id,
            nearest_name(id, ids));
}

void check_effects(const Sample& sample, const std::string& where) {
  for (const auto& [id, theta] : sample.effects) {
    const Effect& effect = find_effect(id, where);
    if (theta < effect.lowest || theta > effect.highest)
      bad_input("{}: effects.{}: found {}, expected {} from {} to {}", where, id, theta, effect.unit,
                effect.lowest, effect.highest);
  }
}

}  // namespace pendular::effects
