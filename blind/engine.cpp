#include "blind/engine.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/nearest.h"

namespace pendular::blind {
namespace {

constexpr double kYadeDamping = 0.2;  // of accelerations, in place of dashpots

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
  // All but the share of polymer above W*, which is not a property of one run.
  return !engine.outside() || effect != "funicular_bridges";
}

}  // namespace pendular::blind
