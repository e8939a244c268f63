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

namespace {

std::list<Effect>& effects() {
  static std::list<Effect> all = {PENDULAR_EFFECTS(PENDULAR_CALL)};
  return all;
}

void check_new(const Effect& effect) {
  Sample sample;
  set_sample_key(sample, "effects." + effect.id, 1.0);  // a name that it can hold
  if (known_effect(effect.id)) bad_input("effect {}: there is one of that name", effect.id);
  for (const auto& text : {effect.unit, effect.name, effect.sentence, effect.meaning})
    if (text.empty()) bad_input("effect {}: expected a unit, a name, a sentence and a meaning", effect.id);
  const bool ranges = effect.lowest <= effect.bank_from && effect.bank_from <= 0.0 && effect.bank_to > 0.0 &&
                      effect.bank_to <= effect.highest;
  if (!ranges)
    bad_input("effect {}: found {} to {} within {} to {}, expected a range about 0 within the accepted one",
              effect.id, effect.bank_from, effect.bank_to, effect.lowest, effect.highest);
}

}  // namespace

const std::list<Effect>& all_effects() {
  return effects();
}

AddedEffect::AddedEffect(Effect effect) {
  check_new(effect);
  place_ = effects().insert(effects().end(), std::move(effect));
}

AddedEffect::~AddedEffect() {
  effects().erase(place_);
}

const Effect* known_effect(const std::string& id) {
  for (const auto& effect : all_effects())
    if (effect.id == id) return &effect;
  return nullptr;
}

const Effect& find_effect(const std::string& id, const std::string& where) {
  if (const Effect* effect = known_effect(id)) return *effect;
  std::vector<std::string> ids;
  for (const auto& effect : all_effects()) ids.push_back(effect.id);
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
