#include "base/sample.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "base/nearest.h"
#include "base/sample_schema.h"

namespace pendular {

const std::vector<NumberKey>& number_keys() {
  const double most_n_per_m = 1e12, most_pa = 1e13;
  const double tiny = std::numeric_limits<double>::min();
  const double um = 1e-6, mm_s = 1e-3;
// A member's name takes no parentheses. NOLINTBEGIN(bugprone-macro-parentheses)
#define PENDULAR_AT(field) [](Sample& s) -> double& { return s.field; }
#define PENDULAR_OPTIONAL(field) [](Sample& s) -> std::optional<double>& { return s.field; }
  // NOLINTEND(bugprone-macro-parentheses)
  static const std::vector<NumberKey> keys = {
      {"beads.diameter_um", um, 0.1, 1e5, PENDULAR_AT(beads.diameter), "mean bead diameter D"},
      {"beads.diameter_sd_um", um, 0.0, 1e4, PENDULAR_AT(beads.diameter_sd), "spread of bead diameters"},
      {"beads.realisation_sd", 1, 0.0, 0.3, PENDULAR_AT(beads.realisation_sd),
       "spread of drawn diameters over D"},
      {"beads.density_kg_m3", 1, 1.0, 3e4, PENDULAR_AT(beads.density), "density of the beads"},
      {"bridges.youngs_modulus_pa", 1, 1.0, 1e12, PENDULAR_AT(bridges.youngs_modulus),
       "Young's modulus E_p of the polymer"},
      {"bridges.poisson_ratio", 1, 0.0, 0.4999, PENDULAR_AT(bridges.poisson_ratio),
       "Poisson ratio of the polymer"},
      {"bridges.diameter_um", um, 0.01, 1e5, PENDULAR_AT(bridges.diameter), "mean neck diameter d"},
      {"bridges.diameter_sd_um", um, 0.0, 1e4, PENDULAR_AT(bridges.diameter_sd), "spread of neck diameters"},
      {"bridges.polymer_content", 1, 1e-6, 0.4, PENDULAR_AT(bridges.polymer_content),
       "W of the specimen, volume of polymer over that of the specimen, for which the diameter holds"},
      {"bridges.gap_um", um, 1e-4, 1e4, PENDULAR_AT(bridges.gap), "gap δ0 for which the stiffness holds"},
      {"bridges.cutoff", 1, 0.0, 1.0, PENDULAR_AT(bridges.cutoff),
       "largest gap of a candidate bridge over D"},
      {"bridges.interfacial_energy_j_m2", 1, 0.0, 1e6, PENDULAR_AT(bridges.interfacial_energy),
       "interfacial energy G"},
      {"bridges.relaxation_time_s", 1, 1e-9, 1e9, PENDULAR_OPTIONAL(bridges.relaxation_time),
       "time in which the polymer relaxes, where an effect makes it"},
      {"bridges.normal_stiffness_n_per_m", 1, tiny, most_n_per_m, PENDULAR_OPTIONAL(bridges.normal_stiffness),
       "bond stiffness kn"},
      {"bridges.tangential_stiffness_n_per_m", 1, tiny, most_n_per_m,
       PENDULAR_OPTIONAL(bridges.tangential_stiffness), "bond stiffness kt"},
      {"contact.stiffness_ratio", 1, 0.01, 1e4, PENDULAR_AT(contact.stiffness_ratio), "k_glass over k_bond"},
      {"contact.friction", 1, 0.0, 10.0, PENDULAR_AT(contact.friction), "friction coefficient between beads"},
      {"contact.platen_friction", 1, 0.0, 10.0, PENDULAR_AT(contact.platen_friction),
       "friction coefficient at the platens"},
      {"contact.damping_fraction", 1, 0.0, 1.0, PENDULAR_AT(contact.damping_fraction),
       "damping over critical damping"},
      {"contact.time_step_fraction", 1, 1e-4, 0.5, PENDULAR_AT(contact.time_step_fraction),
       "time step over √(m_min/k_max)"},
      {"specimen.diameter_um", um, 1.0, 1e6, PENDULAR_AT(specimen.diameter), "diameter of the cylinder"},
      {"specimen.height_um", um, 1.0, 1e6, PENDULAR_AT(specimen.height), "height of the cylinder"},
      {"specimen.volume_fraction", 1, 0.3, 0.64, PENDULAR_AT(specimen.volume_fraction),
       "volume fraction of a generated packing"},
      {"compression.speed", 1, 1e-9, 0.1, PENDULAR_AT(compression.speed), "platen speed over D √(k_glass/m)"},
      {"compression.speed_mm_s", mm_s, 1e-9, 1e6, PENDULAR_OPTIONAL(compression.speed_si), "platen speed"},
      {"compression.stress_rate_pa_s", 1, tiny, most_pa, PENDULAR_OPTIONAL(compression.stress_rate),
       "rate of the stress ramp where control is \"stress\"; the platen goes no faster than the speed"},
      {"compression.max_stress_pa", 1, tiny, most_pa, PENDULAR_OPTIONAL(compression.max_stress),
       "stress at which the run ends"},
      {"compression.relax_increment", 1, 1e-6, 0.01, PENDULAR_AT(compression.relax_increment),
       "strain of an increment where control is \"relaxation\""},
      {"compression.relax_to", 1, 1e-9, 0.1, PENDULAR_AT(compression.relax_to),
       "mean net force over mean force of a pair that counts as rest"},
      {"compression.hold", 1, 0.0, 0.5, PENDULAR_AT(compression.hold),
       "time of a hold: the strain that would be made in it at the speed"},
      {"compression.hold_s", 1, 0.0, 1e6, PENDULAR_OPTIONAL(compression.hold_time), "time of a hold"},
      {"compression.max_strain", 1, 1e-6, 0.5, PENDULAR_AT(compression.max_strain),
       "strain at which the run ends"},
      {"compression.rows_per_strain", 1, 10.0, 1e7, PENDULAR_AT(compression.rows_per_strain),
       "rows of curve.csv per unit strain"},
      {"compression.frames", 1, 0.0, 1e4, PENDULAR_AT(compression.frames),
       "frames written, evenly in strain; 0: none"},
      {"phantom.voxel_um", um, 1e-3, 1e4, PENDULAR_AT(phantom.voxel), "voxel size"},
      {"phantom.blur_voxels", 1, 0.0, 10.0, PENDULAR_AT(phantom.blur_voxels), "sd of the point spread"},
      {"phantom.noise", 1, 0.0, 5.0, PENDULAR_AT(phantom.noise), "white noise over the air–glass edge"},
      {"phantom.correlated_noise", 1, 0.0, 5.0, PENDULAR_AT(phantom.correlated_noise),
       "correlated noise over the edge"},
      {"phantom.correlation_voxels", 1, 0.1, 20.0, PENDULAR_AT(phantom.correlation_voxels),
       "reach of the correlated noise"},
      {"phantom.polymer_contrast", 1, 0.0, 2.0, PENDULAR_AT(phantom.polymer_contrast),
       "polymer over glass, both above air"},
      {"phantom.wall_thickness_um", um, 0.0, 1e5, PENDULAR_AT(phantom.wall_thickness),
       "container wall, 0: none"},
      {"phantom.wall_contrast", 1, 0.0, 5.0, PENDULAR_AT(phantom.wall_contrast),
       "wall over glass, both above air"},
      {"phantom.piston_contrast", 1, 0.0, 5.0, PENDULAR_AT(phantom.piston_contrast),
       "pistons over glass, both above air"},
      {"phantom.margin_um", um, 0.0, 1e5, PENDULAR_AT(phantom.margin), "air around the container"},
      {"phantom.rings", 1, 0.0, 1.0, PENDULAR_AT(phantom.rings), "amplitude of rings over the edge"},
      {"phantom.beam_hardening", 1, 0.0, 0.9, PENDULAR_AT(phantom.beam_hardening),
       "grey value lost on the axis"},
      {"phantom.bits", 1, 8.0, 16.0, PENDULAR_AT(phantom.bits), "8 or 16"},
      {"phantom.air_grey", 1, 0.0, 1.0, PENDULAR_AT(phantom.air_grey), "grey value of air over full scale"},
      {"phantom.glass_grey", 1, 0.0, 1.0, PENDULAR_AT(phantom.glass_grey),
       "grey value of glass over full scale"},
  };
#undef PENDULAR_AT
#undef PENDULAR_OPTIONAL
  return keys;
}

template <>
const std::vector<std::string>& words_for<Diameters>() {
  static const std::vector<std::string> words = {"auto", "measured", "drawn"};
  return words;
}
template <>
const std::vector<std::string>& words_for<StiffnessOf>() {
  static const std::vector<std::string> words = {"one", "per_bridge"};
  return words;
}
template <>
const std::vector<std::string>& words_for<Breaking>() {
  static const std::vector<std::string> words = {"griffith", "limits"};
  return words;
}
template <>
const std::vector<std::string>& words_for<Glass>() {
  static const std::vector<std::string> words = {"linear", "hertz"};
  return words;
}
template <>
const std::vector<std::string>& words_for<TangentialSprings>() {
  static const std::vector<std::string> words = {"one", "two"};
  return words;
}
template <>
const std::vector<std::string>& words_for<Control>() {
  static const std::vector<std::string> words = {"speed", "stress", "relaxation"};
  return words;
}

std::string to_string(Diameters value) {
  return words_for<Diameters>().at(static_cast<std::size_t>(value));
}
std::string to_string(StiffnessOf value) {
  return words_for<StiffnessOf>().at(static_cast<std::size_t>(value));
}
std::string to_string(Breaking value) {
  return words_for<Breaking>().at(static_cast<std::size_t>(value));
}
std::string to_string(Glass value) {
  return words_for<Glass>().at(static_cast<std::size_t>(value));
}
std::string to_string(TangentialSprings value) {
  return words_for<TangentialSprings>().at(static_cast<std::size_t>(value));
}
std::string to_string(Control value) {
  return words_for<Control>().at(static_cast<std::size_t>(value));
}

const std::vector<WordKey>& word_keys() {
#define PENDULAR_WORD(type, field)                                       \
  words_for<type>(), [](const Sample& s) { return to_string(s.field); }, \
      [](Sample& s, std::size_t which) { s.field = static_cast<type>(which); }
  static const std::vector<WordKey> keys = {
      {"beads.diameters", PENDULAR_WORD(Diameters, beads.diameters)},
      {"bridges.stiffness", PENDULAR_WORD(StiffnessOf, bridges.stiffness)},
      {"bridges.breaking", PENDULAR_WORD(Breaking, bridges.breaking)},
      {"contact.glass", PENDULAR_WORD(Glass, contact.glass)},
      {"contact.tangential_springs", PENDULAR_WORD(TangentialSprings, contact.tangential_springs)},
      {"compression.control", PENDULAR_WORD(Control, compression.control)},
  };
#undef PENDULAR_WORD
  return keys;
}

const std::vector<StrainsKey>& strains_keys() {
  static const std::vector<StrainsKey> keys = {
      {"compression.unload_at", [](Sample& s) -> std::vector<double>& { return s.compression.unload_at; }},
      {"compression.hold_at", [](Sample& s) -> std::vector<double>& { return s.compression.hold_at; }},
      {"compression.frame_at", [](Sample& s) -> std::vector<double>& { return s.compression.frame_at; }},
  };
  return keys;
}

const std::vector<SwitchKey>& switch_keys() {
  static const std::vector<SwitchKey> keys = {
      {"contact.bond_friction_limit", [](Sample& s) -> bool& { return s.contact.bond_friction_limit; }},
      {"observe.local_strain", [](Sample& s) -> bool& { return s.observe.local_strain; }},
      {"observe.local_stress", [](Sample& s) -> bool& { return s.observe.local_stress; }},
      {"observe.coordination", [](Sample& s) -> bool& { return s.observe.coordination; }},
      {"observe.damage", [](Sample& s) -> bool& { return s.observe.damage; }},
      {"observe.force_chains", [](Sample& s) -> bool& { return s.observe.force_chains; }},
  };
  return keys;
}

const std::vector<std::string>& required_keys() {
  static const std::vector<std::string> keys = {
      "beads.diameter_um",         "beads.diameter_sd_um",  "beads.density_kg_m3",
      "bridges.youngs_modulus_pa", "bridges.poisson_ratio", "bridges.diameter_um",
      "bridges.diameter_sd_um",    "bridges.gap_um",        "bridges.interfacial_energy_j_m2",
      "contact.friction",          "specimen.diameter_um",  "specimen.height_um",
      "compression.max_strain"};
  return keys;
}

const std::vector<std::string>& later_keys() {
  static const std::vector<std::string> keys = {"beads.diameters", "contact.bond_friction_limit"};
  return keys;
}

std::vector<std::string> sample_key_names() {
  std::vector<std::string> names;
  for (const auto& key : number_keys()) names.push_back(key.name);
  for (const auto& key : word_keys()) names.push_back(key.name);
  for (const auto& key : strains_keys()) names.push_back(key.name);
  for (const auto& key : switch_keys()) names.push_back(key.name);
  names.push_back("specimen.shape");
  return names;
}

namespace {

const NumberKey& find_number_key(const std::string& name) {
  for (const auto& key : number_keys())
    if (key.name == name) return key;
  bad_input("unknown key \"{}\", expected a numeric key of the sample file; the nearest is \"{}\"", name,
            nearest_name(name, sample_key_names()));
}

constexpr std::string_view kEffects = "effects.";

bool is_effect(const std::string& name) {
  return name.starts_with(kEffects);
}

/// Effects are written back as bare TOML keys.
void set_effect(Sample& sample, const std::string& name, double magnitude, const std::string& where) {
  const std::string effect = name.substr(kEffects.size());
  if (effect.empty() ||
      effect.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    bad_input("{}: found \"{}\", expected an effect's name of small letters, digits and _", where, effect);
  if (!std::isfinite(magnitude)) bad_input("{}: found {}, expected a finite number", where, magnitude);
  sample.effects.erase(effect);
  if (magnitude != 0.0) sample.effects[effect] = magnitude;
}

template <typename T>
const T& expect(const SampleValue& value, const std::string& where, const char* expected) {
  if (const T* held = std::get_if<T>(&value)) return *held;
  static constexpr const char* kKinds[] = {"a number", "true or false", "a string", "an array"};
  bad_input("{}: found {}, expected {}", where, kKinds[value.index()], expected);
}

void set_strains(std::vector<double>& field, const std::vector<double>& strains, const std::string& where) {
  double last = 0.0;
  for (const double strain : strains) {
    if (!(strain > last && strain <= 0.5))
      bad_input("{}: found {}, expected rising strains between 0 and 0.5", where, strain);
    last = strain;
  }
  field = strains;
}

}  // namespace

void NumberKey::set(Sample& sample, double value, const std::string& where) const {
  if (!(value >= lowest && value <= highest))
    bad_input("{}: found {}, expected a number from {} to {}", where, value, lowest, highest);
  if (const auto* plain = std::get_if<PlainField>(&field))
    (*plain)(sample) = value * unit;
  else
    std::get<OptionalField>(field)(sample) = value * unit;
}

std::optional<double> NumberKey::in_si(const Sample& sample) const {
  Sample copy = sample;
  if (const auto* plain = std::get_if<PlainField>(&field)) return (*plain)(copy);
  return std::get<OptionalField>(field)(copy);
}

std::optional<double> NumberKey::get(const Sample& sample) const {
  auto value = in_si(sample);
  if (value) *value /= unit;
  return value;
}

void WordKey::set(Sample& sample, const std::string& word, const std::string& where) const {
  const auto found = std::find(allowed.begin(), allowed.end(), word);
  if (found == allowed.end())
    bad_input("{}: found \"{}\", expected one of \"{}\"", where, word, fmt::join(allowed, "\", \""));
  assign(sample, static_cast<std::size_t>(found - allowed.begin()));
}

std::vector<SampleKey> sample_keys() {
  std::vector<SampleKey> keys;
  for (const auto& key : number_keys()) keys.push_back({key.name, key.lowest, key.highest, key.meaning});
  return keys;
}

void set_sample_key(Sample& sample, const std::string& name, const SampleValue& value,
                    const std::string& where) {
  for (const auto& key : number_keys())
    if (key.name == name) return key.set(sample, expect<double>(value, where, "a number"), where);
  for (const auto& key : word_keys())
    if (key.name == name) return key.set(sample, expect<std::string>(value, where, "a string"), where);
  for (const auto& key : strains_keys())
    if (key.name == name)
      return set_strains(key.field(sample), expect<std::vector<double>>(value, where, "an array of strains"),
                         where);
  for (const auto& key : switch_keys())
    if (key.name == name) {
      key.field(sample) = expect<bool>(value, where, "true or false");
      return;
    }
  if (is_effect(name)) return set_effect(sample, name, expect<double>(value, where, "a number"), where);
  if (name == "specimen.shape") {
    if (value != SampleValue("cylinder")) bad_input("{}: expected \"cylinder\"", where);
    return;
  }
  bad_input("{}: unknown key, the nearest known one is \"{}\"", where,
            nearest_name(name, sample_key_names()));
}

void set_sample_key(Sample& sample, const std::string& name, double value) {
  if (is_effect(name)) return set_effect(sample, name, value, name);
  find_number_key(name).set(sample, value, name);
}

double sample_key(const Sample& sample, const std::string& name) {
  if (is_effect(name)) {
    const auto effect = sample.effects.find(name.substr(kEffects.size()));
    return effect == sample.effects.end() ? 0.0 : effect->second;
  }
  const auto value = find_number_key(name).get(sample);
  if (!value) bad_input("{} is not set in this sample", name);
  return *value;
}

namespace {

/// A number in the key's unit that makes the field's value again, bit for bit; the plainest of them.
std::optional<double> exact_number(const NumberKey& key, double in_unit, const Sample& sample) {
  const auto beside = [&](double towards) { return std::nextafter(in_unit, towards); };
  const double plain = std::strtod(fmt::format("{:.15g}", in_unit).c_str(), nullptr);
  for (const double candidate :
       {plain, in_unit, beside(0.0), beside(HUGE_VAL), std::nextafter(beside(0.0), 0.0),
        std::nextafter(beside(HUGE_VAL), HUGE_VAL)}) {
    if (!(candidate >= key.lowest && candidate <= key.highest)) continue;
    Sample again = sample;
    key.set(again, candidate, key.name);
    if (key.in_si(again) == key.in_si(sample)) return candidate;
  }
  return std::nullopt;
}

/// The same, or for a value that no number in the key's unit makes, that of the nearest value.
double number_for(const NumberKey& key, double in_unit, const Sample& sample) {
  if (const auto exact = exact_number(key, in_unit, sample)) return *exact;
  const double near = std::clamp(in_unit, key.lowest, key.highest);
  Sample rounded = sample;
  key.set(rounded, near, key.name);
  return exact_number(key, near, rounded).value_or(near);
}

}  // namespace

std::vector<SampleSetting> sample_settings(const Sample& sample) {
  Sample copy = sample;
  std::vector<SampleSetting> settings;
  for (const auto& key : number_keys())
    if (const auto value = key.get(sample)) settings.emplace_back(key.name, number_for(key, *value, sample));
  for (const auto& key : word_keys()) settings.emplace_back(key.name, key.field(copy));
  for (const auto& key : strains_keys()) settings.emplace_back(key.name, key.field(copy));
  for (const auto& key : switch_keys()) settings.emplace_back(key.name, key.field(copy));
  for (const auto& [effect, magnitude] : sample.effects)
    settings.emplace_back(std::string(kEffects) + effect, magnitude);
  return settings;
}

void set_polymer_content(Sample& sample, double content) {
  if (!(content > 0.0)) bad_input("W: found {}, expected a positive fraction", content);
  const double factor = std::sqrt(content / sample.bridges.polymer_content);
  set_sample_key(sample, "bridges.polymer_content", content);
  for (const char* name : {"bridges.diameter_um", "bridges.diameter_sd_um"})
    set_sample_key(sample, name, factor * sample_key(sample, name));
}

}  // namespace pendular
