#include <fmt/ranges.h>

#include <map>
#include <set>

#include "base/error.h"
#include "base/progress.h"
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
  if (sample.bridges.normal_stiffness && sample.bridges.stiffness == StiffnessOf::per_bridge)
    bad_input(
        "{}: bridges.stiffness = \"per_bridge\" and bridges.normal_stiffness_n_per_m: expected one of them, "
        "because a given stiffness is the same for all bonds",
        file);
  const auto& compression = sample.compression;
  if ((compression.control == Control::stress) != compression.stress_rate.has_value())
    bad_input(
        "{}: compression.control = \"{}\" {} compression.stress_rate_pa_s: expected control = \"stress\" and "
        "the rate of its ramp, or neither",
        file, to_string(compression.control), compression.stress_rate ? "with" : "without");
  if (compression.control != Control::speed &&
      !(compression.unload_at.empty() && compression.hold_at.empty()))
    bad_input("{}: compression.unload_at and compression.hold_at: expected only where control is \"speed\"",
              file);
  if (sample.phantom.bits != 8.0 && sample.phantom.bits != 16.0)
    bad_input("{}: phantom.bits = {}: expected 8 or 16", file, sample.phantom.bits);
  if (sample.phantom.air_grey == sample.phantom.glass_grey)
    bad_input("{}: phantom.air_grey and phantom.glass_grey are both {}: expected different values", file,
              sample.phantom.air_grey);
}

/// A sample and the keys that were given for it.
struct Given {
  Sample sample;
  std::set<std::string> keys;

  std::vector<std::string> without(const std::vector<std::string>& asked) const {
    std::vector<std::string> absent;
    for (const auto& key : asked)
      if (!keys.contains(key)) absent.push_back(key);
    return absent;
  }
};

Given given_in(std::string_view text, const std::string& name, const std::vector<SampleSetting>& settings) {
  const toml::table root = parse_toml(text, name);
  Given given;
  Sample& sample = given.sample;
  for (const auto& [section, node] : root) {
    const auto* table = node.as_table();
    const std::string prefix(section.str());
    if (!table)
      bad_input("{}",
                TomlPlace{name, prefix, node}.str() + ": unknown key, expected a section such as [beads]");
    for (const auto& [key, value] : *table) {
      const TomlPlace place{name, prefix + "." + std::string(key.str()), value};
      set_sample_key(sample, place.name, value_at(place), place.str());
      given.keys.insert(place.name);
    }
  }
  for (const auto& [key, value] : settings) {
    set_sample_key(sample, key, value, fmt::format("{}: {}", name, key));
    given.keys.insert(key);
  }
  // The paper treats a platen "the same way as another particle" unless the experimenter knows better.
  if (!given.keys.contains("contact.platen_friction"))
    sample.contact.platen_friction = sample.contact.friction;
  check_together(sample, name);
  return given;
}

}  // namespace

Sample parse_sample(std::string_view text, const std::string& name,
                    const std::vector<SampleSetting>& settings) {
  return given_in(text, name, settings).sample;
}

Sample whole_sample(std::string_view text, const std::string& name,
                    const std::vector<SampleSetting>& settings) {
  const Given given = given_in(text, name, settings);
  if (const auto absent = given.without(required_keys()); !absent.empty())
    bad_input("{}: found no {}; expected a sample that states them (is the file cut short?)", name,
              fmt::join(absent, ", "));
  return given.sample;
}

void warn_of_later_keys(std::string_view text, const std::string& name) {
  if (const auto absent = given_in(text, name, {}).without(later_keys()); !absent.empty())
    warn(fmt::format("{}: lacks {}, as samples of earlier versions do: taken as docs/sample.md says", name,
                     fmt::join(absent, " and ")));
}

Sample read_sample(const fs::path& path) {
  const std::string text = read_text(path);
  Sample sample = whole_sample(text, path.string());
  warn_of_later_keys(text, path.string());
  return sample;
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
