#include "diagnosis/experiment/experiment.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/csv.h"
#include "base/nearest.h"
#include "base/toml_place.h"
#include "diagnosis/experiment/believed.h"
#include "diagnosis/kinds/kind.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

/// Cells of text columns are read by the kind itself.
void read_columns(Observation& observation, const CsvTable& table) {
  const Kind& kind = *observation.kind;
  if (table.rows() < kind.least_rows)
    bad_input("{}: found {} row(s), expected at least {} for {}", observation.file.string(), table.rows(),
              kind.least_rows, kind.name);
  for (const auto* names : {&kind.required, &kind.optional})
    for (const auto& name : *names)
      if (table.has(name)) observation.columns[name] = table.numbers(name);
  if (kind.read) kind.read(observation, table);
}

CsvTable table_of(const Observation& observation) {
  std::vector<std::string> optional = observation.kind->optional;
  if (observation.kind->read) optional.push_back("state");
  return read_csv(observation.file, observation.kind->required, optional);
}

void set_key(Observation& observation, const KindKey& key, const TomlPlace& place) {
  if (key.words.empty()) {
    const double value = number_at(place);
    if (value < key.lowest || value > key.highest)
      bad_input("{}: found {}, expected {} to {}", place.str(), value, key.lowest, key.highest);
    observation.numbers[key.name] = value;
    return;
  }
  const std::string word = word_at(place);
  if (std::find(key.words.begin(), key.words.end(), word) == key.words.end())
    bad_input("{}: found \"{}\", expected one of \"{}\"", place.str(), word, fmt::join(key.words, "\", \""));
  observation.words[key.name] = word;
}

std::vector<SampleSetting> settings_at(const TomlPlace& place) {
  const auto* table = place.node.as_table();
  if (!table) bad_input("{}: found {}, expected a table of dotted keys", place.str(), type_name(place.node));
  std::vector<SampleSetting> settings;
  for (const auto& [key, node] : *table) {
    const TomlPlace here{place.file, std::string(key.str()), node};
    settings.emplace_back(here.name, value_at(here));
    Sample thrown_away;
    set_sample_key(thrown_away, here.name, settings.back().second, here.str());
  }
  return settings;
}

Observation observation_at(const TomlPlace& place) {
  std::vector<std::string> known = {"kind", "name", "file", "set", "beads"};
  const auto* table = place.node.as_table();
  if (!table) bad_input("{}: found {}, expected [[observation]]", place.str(), type_name(place.node));
  for (const char* needed : {"kind", "file"})
    if (!table->contains(needed)) bad_input("{}: {} is missing", place.str(), needed);
  const auto at = [&](const std::string& key) {
    return TomlPlace{place.file, "observation." + key, *table->get(key)};
  };
  Observation observation;
  observation.kind = find_kind(word_at(at("kind")), at("kind").str());
  for (const auto& key : observation.kind->keys) {
    known.push_back(key.name);
    if (table->contains(key.name))
      set_key(observation, key, at(key.name));
    else if (key.words.empty())
      observation.numbers[key.name] = key.otherwise;
    else
      observation.words[key.name] = key.words.front();
  }
  for (const auto& [node_key, node] : *table) {
    const std::string key(node_key.str());
    if (key == "name")
      observation.name = word_at(at(key));
    else if (key == "file")
      observation.file = file_at(at(key));
    else if (key == "beads")
      observation.beads = file_at(at(key));
    else if (key == "set")
      observation.set = settings_at(at(key));
    else if (std::find(known.begin(), known.end(), key) == known.end())
      bad_input("{}: unknown key, the nearest known one is \"observation.{}\"", at(key).str(),
                nearest_name(key, known));
  }
  if (observation.name.empty()) observation.name = observation.file.stem().string();
  read_columns(observation, table_of(observation));
  return observation;
}

std::map<std::string, double> uncertainties_at(const TomlPlace& place) {
  const auto* table = place.node.as_table();
  if (!table) bad_input("{}: found {}, expected [uncertainty]", place.str(), type_name(place.node));
  std::map<std::string, double> sigmas;
  for (const auto& [key, node] : *table) {
    const TomlPlace here{place.file, std::string(key.str()), node};
    const double sigma = number_at(here);
    if (!(sigma >= 0.0)) bad_input("{}: found {}, expected a standard deviation", here.str(), sigma);
    std::vector<std::string> names;
    for (const auto& known : sample_keys()) names.push_back(known.name);
    if (std::find(names.begin(), names.end(), here.name) == names.end())
      bad_input("{}: unknown key, the nearest numeric key of a sample is \"{}\"", here.str(),
                nearest_name(here.name, names));
    sigmas[here.name] = sigma;
  }
  return sigmas;
}

void read_head(Experiment& experiment, const TomlPlace& place) {
  const auto* table = place.node.as_table();
  if (!table) bad_input("{}: found {}, expected [experiment]", place.str(), type_name(place.node));
  for (const auto& [key, node] : *table) {
    const TomlPlace here{place.file, "experiment." + std::string(key.str()), node};
    if (key == "name")
      experiment.name = word_at(here);
    else if (key == "sample")
      experiment.sample_file = file_at(here);
    else
      bad_input("{}: unknown key, the nearest known one is \"experiment.{}\"", here.str(),
                nearest_name(std::string(key.str()), {"name", "sample"}));
  }
}

void read_observations(Experiment& experiment, const TomlPlace& place) {
  const auto* array = place.node.as_array();
  if (!array) bad_input("{}: found {}, expected [[observation]]", place.str(), type_name(place.node));
  std::set<std::string> names;
  for (const auto& node : *array) {
    experiment.observations.push_back(observation_at({place.file, "observation", node}));
    const std::string& name = experiment.observations.back().name;
    if (!names.insert(name).second)
      bad_input("{}: two observations are named \"{}\", expected a name for each",
                TomlPlace{place.file, "observation", node}.str(), name);
  }
}

/// Uncertainties of zero tell nothing: the column counts as not given.
void drop_empty_sigmas(Experiment& experiment, Observation& observation) {
  for (auto it = observation.columns.begin(); it != observation.columns.end();) {
    const auto& [name, column] = *it;
    const bool sigma = name.find("sigma") != std::string::npos;
    const auto [least, most] = std::minmax_element(column.begin(), column.end());
    if (sigma && *least < 0.0)
      bad_input("{}: {}: found a negative standard deviation", observation.file.string(), name);
    const bool kept = !sigma || *least > 0.0 || name == "sigma_bridge_diameter_um";  // no neck, no error
    if (kept) {
      ++it;
      continue;
    }
    experiment.warnings.push_back(observation.name + ": " + name + " holds zeros; it counts as not given");
    it = observation.columns.erase(it);
  }
}

}  // namespace

Sample Experiment::sample_of(const Observation& observation) const {
  return changed_sample(sample, [&](Sample& changed) {
    for (const auto& [key, value] : observation.set)
      set_sample_key(changed, key, value, observation.name + ": " + key);
  });
}

namespace {

/// The file without what its observations hold.
Experiment read_sections(const fs::path& path) {
  const std::string file = path.string();
  const toml::table root = parse_toml(read_text(path), file);
  Experiment experiment;
  for (const auto& [key, node] : root) {
    const TomlPlace place{file, std::string(key.str()), node};
    if (key == "experiment")
      read_head(experiment, place);
    else if (key == "uncertainty")
      experiment.uncertainty = uncertainties_at(place);
    else if (key == "observation")
      read_observations(experiment, place);
    else
      bad_input("{}: unknown section, expected [experiment], [uncertainty] or [[observation]]", place.str());
  }
  if (experiment.sample_file.empty())
    bad_input("{}: experiment.sample is missing, expected a sample file", file);
  if (experiment.name.empty()) experiment.name = path.stem().string();
  experiment.sample = read_sample(experiment.sample_file);
  return experiment;
}

}  // namespace

Experiment read_experiment(const fs::path& path) {
  Experiment experiment = read_sections(path);
  if (experiment.observations.empty())
    bad_input("{}: found no [[observation]], expected at least one", path.string());
  for (auto& observation : experiment.observations) {
    if (observation.kind->check)
      observation.kind->check(experiment.sample_of(observation), observation, experiment.warnings);
    drop_empty_sigmas(experiment, observation);
  }
  std::set<fs::path> files;
  for (const auto& observation : experiment.observations)
    if (!observation.beads.empty()) files.insert(observation.beads);
  std::vector<std::vector<Bead>> tables;
  for (const auto& one : files) tables.push_back(read_beads(one));
  experiment.contacts = contact_peak(tables);
  return experiment;
}

std::optional<Experiment> read_beliefs(const fs::path& path) {
  const toml::table root = parse_toml(read_text(path), path.string());
  if (root.contains("observation")) return std::nullopt;
  if (root.contains("experiment")) return read_sections(path);
  Experiment experiment;
  experiment.name = path.stem().string(), experiment.sample_file = path;
  experiment.sample = read_sample(path);
  return experiment;
}

}  // namespace pendular::diagnosis
