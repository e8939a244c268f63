#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/sample.h"
#include "base/sample_schema.h"

namespace pendular {
namespace {

struct Place {
  std::string file;
  std::string name;
  const toml::node& node;

  std::string str() const { return fmt::format("{}:{}: {}", file, node.source().begin.line, name); }
};

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a string";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "another type";
  }
}

double number_at(const Place& place) {
  if (!place.node.is_number())
    bad_input("{}: found {}, expected a number", place.str(), type_name(place.node));
  const double value = place.node.value<double>().value();
  if (!std::isfinite(value)) bad_input("{}: found {}, expected a finite number", place.str(), value);
  return value;
}

void read_word(Sample& sample, const WordKey& key, const Place& place) {
  const auto word = place.node.value<std::string>();
  if (!place.node.is_string() ||
      std::find(key.allowed.begin(), key.allowed.end(), *word) == key.allowed.end())
    bad_input("{}: found {}, expected one of \"{}\"", place.str(),
              word ? '"' + *word + '"' : type_name(place.node), fmt::join(key.allowed, "\", \""));
  key.field(sample) = *word;
}

void read_strains(std::vector<double>& strains, const Place& place) {
  const auto* array = place.node.as_array();
  if (!array) bad_input("{}: found {}, expected an array of strains", place.str(), type_name(place.node));
  strains.clear();
  for (const auto& item : *array) {
    const double strain = number_at({place.file, place.name, item});
    if (strain <= 0.0 || strain > 0.5 || (!strains.empty() && strain <= strains.back()))
      bad_input("{}: found {}, expected rising strains between 0 and 0.5", place.str(), strain);
    strains.push_back(strain);
  }
}

void read_key(Sample& sample, const Place& place) {
  for (const auto& key : number_keys()) {
    if (key.name != place.name) continue;
    const double value = number_at(place);
    if (!(value >= key.lowest && value <= key.highest))
      bad_input("{}: found {}, expected a number from {} to {}", place.str(), value, key.lowest, key.highest);
    key.set(sample, value);
    return;
  }
  for (const auto& key : word_keys())
    if (key.name == place.name) return read_word(sample, key, place);
  if (place.name == "compression.unload_at") return read_strains(sample.compression.unload_at, place);
  if (place.name == "compression.hold_at") return read_strains(sample.compression.hold_at, place);
  if (place.name == "contact.bond_friction_limit") {
    if (!place.node.is_boolean())
      bad_input("{}: found {}, expected true or false", place.str(), type_name(place.node));
    sample.contact.bond_friction_limit = place.node.value<bool>().value();
    return;
  }
  if (place.name == "specimen.shape") {
    if (place.node.value<std::string>() != "cylinder") bad_input("{}: expected \"cylinder\"", place.str());
    return;
  }
  bad_input("{}: unknown key, the nearest known one is \"{}\"", place.str(), nearest_key(place.name));
}

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
  if (compression.control == "stress" && !(compression.unload_at.empty() && compression.hold_at.empty()))
    bad_input("{}: compression.unload_at and compression.hold_at: expected only where control is \"speed\"",
              file);
  if (sample.phantom.bits != 8.0 && sample.phantom.bits != 16.0)
    bad_input("{}: phantom.bits = {}: expected 8 or 16", file, sample.phantom.bits);
  if (sample.phantom.air_grey == sample.phantom.glass_grey)
    bad_input("{}: phantom.air_grey and phantom.glass_grey are both {}: expected different values", file,
              sample.phantom.air_grey);
}

}  // namespace

Sample parse_sample(std::string_view text, const std::string& name) {
  toml::table root;
  try {
    root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    bad_input("{}:{}: {}", name, error.source().begin.line, error.description());
  }
  Sample sample;
  bool platen_friction_given = false;
  for (const auto& [section, node] : root) {
    const auto* table = node.as_table();
    const std::string prefix(section.str());
    if (!table)
      bad_input("{}", Place{name, prefix, node}.str() + ": unknown key, expected a section such as [beads]");
    for (const auto& [key, value] : *table) {
      const std::string dotted = prefix + "." + std::string(key.str());
      read_key(sample, {name, dotted, value});
      platen_friction_given |= dotted == "contact.platen_friction";
    }
  }
  // The paper treats a platen "the same way as another particle" unless the experimenter knows better.
  if (!platen_friction_given) sample.contact.platen_friction = sample.contact.friction;
  check_together(sample, name);
  return sample;
}

Sample read_sample(const fs::path& path) {
  return parse_sample(read_text(path), path.string());
}

}  // namespace pendular
