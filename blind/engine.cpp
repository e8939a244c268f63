#include "blind/engine.h"

#include <algorithm>
#include <array>
#include <set>

#include "base/error.h"
#include "base/nearest.h"

namespace pendular::blind {
namespace {

constexpr double kYadeDamping = 0.2;  // of accelerations, in place of dashpots
// Effects that it has: coded in its scripts (blind/yade) or, of the measurement, made by the project's own
// code. No other one is drawn for it.
constexpr std::array kOfYade = {"bridge_gap_spread", "bridge_diameter_spread", "missing_bridges",
                                "bridge_bending",    "polymer_nonlinearity",   "polymer_viscoelasticity",
                                "bond_damage",       "interface_strength",     "residual_stress",
                                "bead_friction",     "platen_friction",        "platen_tilt",
                                "platen_roughness",  "machine_compliance",     "voxel_scale",
                                "loading_rate",      "position_error",         "diameter_bias"};

}  // namespace

const std::vector<Engine>& engines() {
  static const std::vector<Engine> all = {
      {"yade", "Yade: Griffith's ellipse, linear glass", {}, "linear", "griffith", kYadeDamping},
      {"yade_limits", "Yade: a tensile and a shear limit", {}, "linear", "limits", kYadeDamping},
      {"yade_hertz", "Yade: glass after Hertz and Mindlin", {}, "hertz", "griffith", kYadeDamping},
      {"one_spring",
       "one tangential spring per pair",
       {{"contact.tangential_springs", std::string("one")}},
       {},
       {}},
      {"coulomb_bonds", "Coulomb's limit on bonds too", {{"contact.bond_friction_limit", true}}, {}, {}},
      {"damped", "three times the damping", {{"contact.damping_fraction", 0.3}}, {}, {}},
      {"hertz", "glass after Hertz", {{"contact.glass", std::string("hertz")}}, {}, {}},
  };
  return all;
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const auto& engine : engines()) names.push_back(engine.name);
  return names;
}

const Engine& find_engine(const std::string& name, const std::string& where) {
  for (const auto& engine : engines())
    if (engine.name == name) return engine;
  bad_input("{}: unknown engine \"{}\", the nearest known one is \"{}\"", where, name,
            nearest_name(name, engine_names()));
}

bool has_effect(const Engine& engine, const std::string& effect) {
  return !engine.outside() || std::find(kOfYade.begin(), kOfYade.end(), effect) != kOfYade.end();
}

}  // namespace pendular::blind
