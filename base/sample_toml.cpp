#include <cmath>
#include <map>

#include "base/error.h"
#include "base/sample.h"
#include "base/sample_schema.h"
#include "base/toml_place.h"

namespace pendular {
namespace {

void check_together(const Sample& sample, const std::string& file) {
  if (sample.bridges.diameter >= sample.beads.diameter)
    bad_input("{}: bridges.diameter_um = {:.4g}: expected less than beads.diameter_um = {:.4g}", file,
              1e6 * sample.bridges.diameter, 1e6 * sample.beads.diameter);
  if (sample.bridges.normal_stiffness.has_value() != sample.bridges.tangential_stiffness.has_value())
    bad_input(
        "{}: bridges: normal_stiffness_n_per_m and tangential_stiffness_n_per_m: expected both or neither",
        file);
  if (sample.bridges.normal_stiffness && sample.bridges.stiffness == "per_bridge")
    bad_input(
        "{}: bridges.stiffness = \"per_bridge\" and bridges.normal_stiffness_n_per_m: expected one of them, "
        "because a given stiffness is the same for all bonds",
        file);
  const auto& compression = sample.compression;
  if ((compression.control == "stress") != compression.stress_rate.has_value())
    bad_input(
        "{}: compression.control = \"{}\" {} compression.stress_rate_pa_s: expected control = \"stress\" and "
        "the rate of its ramp, or neither",
        file, compression.control, compression.stress_rate ? "with" : "without");
  if (compression.control != "speed" && !(compression.unload_at.empty() && compression.hold_at.empty()))
    bad_input("{}: compression.unload_at and compression.hold_at: expected only where control is \"speed\"",
              file);
  if (sample.phantom.bits != 8.0 && sample.phantom.bits != 16.0)
    bad_input("{}: phantom.bits = {}: expected 8 or 16", file, sample.phantom.bits);
  if (sample.phantom.air_grey == sample.phantom.glass_grey)
    bad_input("{}: phantom.air_grey and phantom.glass_grey are both {}: expected different values", file,
              sample.phantom.air_grey);
}

}  // namespace

Sample parse_sample(std::string_view text, const std::string& name,
                    const std::vector<SampleSetting>& settings) {
  const toml::table root = parse_toml(text, name);
  Sample sample;
  bool platen_friction_given = false;
  for (const auto& [section, node] : root) {
    const auto* table = node.as_table();
    const std::string prefix(section.str());
    if (!table)
      bad_input("{}",
                TomlPlace{name, prefix, node}.str() + ": unknown key, expected a section such as [beads]");
    for (const auto& [key, value] : *table) {
      const TomlPlace place{name, prefix + "." + std::string(key.str()), value};
      set_sample_key(sample, place.name, value_at(place), place.str());
      platen_friction_given |= place.name == "contact.platen_friction";
    }
  }
  for (const auto& [key, value] : settings) {
    set_sample_key(sample, key, value, name + ": " + key);
    platen_friction_given |= key == "contact.platen_friction";
  }
  // The paper treats a platen "the same way as another particle" unless the experimenter knows better.
  if (!platen_friction_given) sample.contact.platen_friction = sample.contact.friction;
  check_together(sample, name);
  return sample;
}

Sample read_sample(const fs::path& path) {
  return parse_sample(read_text(path), path.string());
}

namespace {

/// A value as the file has it.
struct Written {
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(const std::string& word) const { return '"' + word + '"'; }
  std::string operator()(const std::vector<double>& numbers) const {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
  }
};

}  // namespace

std::string sample_text(const Sample& sample) {
  std::map<std::string, std::string> sections;
  for (const auto& [name, value] : sample_settings(sample)) {
    const auto dot = name.find('.');
    sections[name.substr(0, dot)] +=
        fmt::format("{} = {}\n", name.substr(dot + 1), std::visit(Written{}, value));
  }
  std::string text;
  for (const auto& [section, keys] : sections) text += fmt::format("[{}]\n{}", section, keys);
  return text;
}

}  // namespace pendular
