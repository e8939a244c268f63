#include "blind/mechanism.h"

#include "base/error.h"
#include "base/nearest.h"

namespace pendular::blind {

// One line each; its file has the same name.
#define PENDULAR_MECHANISMS(mechanism)                                                       \
  mechanism(weak_layer) mechanism(crack) mechanism(bridge_yield) mechanism(tension_softness) \
      mechanism(soft_contacts) mechanism(grit) mechanism(platen_overhang) mechanism(sleeve)  \
          mechanism(cell_saturation) mechanism(encoder_backlash) mechanism(tared_preload)    \
              mechanism(slow_logger) mechanism(wrong_height)

#define PENDULAR_DECLARE(id) Mechanism id();
#define PENDULAR_CALL(id) id(),
PENDULAR_MECHANISMS(PENDULAR_DECLARE)

const std::vector<Mechanism>& all_mechanisms() {
  static const std::vector<Mechanism> mechanisms = {PENDULAR_MECHANISMS(PENDULAR_CALL)};
  return mechanisms;
}

const Mechanism& find_mechanism(const std::string& id, const std::string& where) {
  std::vector<std::string> ids;
  for (const auto& mechanism : all_mechanisms()) {
    if (mechanism.id == id) return mechanism;
    ids.push_back(mechanism.id);
  }
  bad_input("{}: unknown mechanism \"{}\", the nearest known one is \"{}\"", where, id,
            nearest_name(id, ids));
}

}  // namespace pendular::blind
