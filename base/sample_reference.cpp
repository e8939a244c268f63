#include "base/sample_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "base/sample_schema.h"

namespace pendular {
namespace {

/// Of the keys that are no numbers, whose list has no place for it.
const std::map<std::string, std::string> kMeanings = {
    {"beads.diameters",
     "`measured`: as in the packing; `drawn`: anew, as in the paper; `auto`: measured where errors are "
     "stated, else drawn"},
    {"bridges.stiffness",
     "by finite elements, where no stiffness is stated: `one`, the mean bridge's for all bonds; "
     "`per_bridge`, "
     "each bridge's own"},
    {"bridges.breaking",
     "of bonds: `griffith`, an energy of tension, compression and shear together, as in the paper; `limits`, "
     "one of tension "
     "or one of shear ([model.md](model.md))"},
    {"contact.glass",
     "normal force of glass on glass: `linear`; `hertz`, as the overlap to 3/2, the same force at an overlap "
     "of D/200 "
     "([model.md](model.md))"},
    {"contact.tangential_springs",
     "`two`: bond and glass apart; `one`: a single spring, stiffer once glass touches "
     "([model.md](model.md))"},
    {"contact.bond_friction_limit",
     "Coulomb's limit also on the tangential force of bonds ([model.md](model.md))"},
    {"specimen.shape", "the only one"},
    {"compression.control",
     "of the moving platen: constant `speed`, a ramp of `stress`, or increments with the specimen at rest "
     "after each (`relaxation`)"},
    {"compression.unload_at", "strains at which the platen returns to zero stress once"},
    {"compression.hold_at", "strains at which the platen rests"},
    {"compression.frame_at", "strains at which further frames are written"},
    {"observe.local_strain", "frames have `local_shear_strain`, `local_volumetric_strain`"},
    {"observe.local_stress", "frames have `pressure_pa`, `deviatoric_stress_pa`"},
    {"observe.coordination", "frames have `coordination`, `touching`"},
    {"observe.damage", "frames have `damage`"},
    {"observe.force_chains", "frames have `normal_force_n`, `force_chain`"},
};

/// "1e5" for 1e+05.
std::string number(double value) {
  std::string text = fmt::format("{:g}", value);
  const auto e = text.find('e');
  if (e == std::string::npos) return text;
  std::string exponent = text.substr(e + 1);
  const std::string sign = exponent[0] == '-' ? "-" : "";
  exponent.erase(0, std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  return text.substr(0, e + 1) + sign + exponent;
}

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What a file that leaves the key out is read as.
std::string absent(const std::string& name, const std::string& otherwise) {
  if (among(required_keys(), name)) return "required";
  if (name == "contact.platen_friction") return "`friction`";
  return among(later_keys(), name) ? otherwise + ", with a warning" : otherwise;
}

std::string range_of(const NumberKey& key) {
  const bool open = key.lowest > 0.0 && key.lowest < 1e-100;
  return fmt::format("{} to {}", open ? "above 0" : number(key.lowest), number(key.highest));
}

}  // namespace

std::vector<SampleReference> sample_reference() {
  Sample sample;
  std::vector<SampleReference> all;
  const auto add = [&](const std::string& name, const std::string& values, const std::string& otherwise,
                       const std::string& meaning) {
    all.push_back({name, values, absent(name, otherwise), meaning});
  };
  for (const auto& key : number_keys()) {
    const auto value = key.get(sample);
    add(key.name, range_of(key), value ? number(*value) : "–", key.meaning);
  }
  for (const auto& key : word_keys())
    add(key.name, fmt::format("`{}`", fmt::join(key.allowed, "`, `")), fmt::format("`{}`", key.field(sample)),
        kMeanings.at(key.name));
  add("specimen.shape", "`cylinder`", "`cylinder`", kMeanings.at("specimen.shape"));
  for (const auto& key : strains_keys())
    add(key.name, "rising strains to 0.5", "none", kMeanings.at(key.name));
  for (const auto& key : switch_keys())
    add(key.name, "true, false", key.field(sample) ? "true" : "false", kMeanings.at(key.name));
  const std::vector<std::string> sections = {"beads",       "bridges", "contact", "specimen",
                                             "compression", "observe", "phantom"};
  std::stable_sort(all.begin(), all.end(), [&](const SampleReference& a, const SampleReference& b) {
    const auto place = [&](const SampleReference& one) {
      return std::find(sections.begin(), sections.end(), one.name.substr(0, one.name.find('.')));
    };
    return place(a) < place(b);
  });
  return all;
}

}  // namespace pendular
