#include "diagnosis/experiment.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/csv.h"
#include "base/nearest.h"
#include "base/toml_place.h"
#include "diagnosis/believed.h"
#include "diagnosis/plausible.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

/// How a kind of observation is written.
struct Form {
  Kind kind;
  std::string name;
  std::vector<std::string> required, optional;
  std::size_t least_rows;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> all = {
      {Kind::compression, "compression", {"strain", "stress_pa"}, {"stress_sigma_pa"}, 8},
      {Kind::lateral_strain, "lateral_strain", {"strain", "lateral_strain"}, {"sigma"}, 4},
      {Kind::modulus_series, "modulus_series", {"modulus_pa", "modulus_sigma_pa"}, {"E_p_pa", "W"}, 1},
      {Kind::bridge_stiffness,
       "bridge_stiffness",
       {"d_um", "D_um"},
       {"kn_n_per_m", "kn_sigma_n_per_m", "kt_n_per_m", "kt_sigma_n_per_m"},
       1},
      {Kind::bridge_diameters, "bridge_diameters", {"d_um"}, {}, 4},
      {Kind::bridge_gaps, "bridge_gaps", {"gap_um"}, {"sigma_um"}, 4},
      {Kind::coordination, "coordination", {"z", "z_sigma"}, {}, 1},
      {Kind::displacements,
       "displacements",
       {"strain", "bead_id", "x_um", "y_um", "z_um", "ux_um", "uy_um", "uz_um"},
       {},
       20},
      {Kind::broken_bonds, "broken_bonds", {"strain", "count"}, {}, 2},
  };
  return all;
}

const Form& form_of(Kind kind) {
  return *std::find_if(forms().begin(), forms().end(), [&](const Form& f) { return f.kind == kind; });
}

Kind kind_at(const TomlPlace& place) {
  const std::string word = word_at(place);
  std::vector<std::string> names;
  for (const auto& form : forms()) {
    if (form.name == word) return form.kind;
    names.push_back(form.name);
  }
  bad_input("{}: found \"{}\", the nearest known kind is \"{}\"", place.str(), word,
            nearest_name(word, names));
}

void read_columns(Observation& observation) {
  const Form& form = form_of(observation.kind);
  const CsvTable table = read_csv(observation.file, form.required, form.optional);
  for (const auto* names : {&form.required, &form.optional})
    for (const auto& name : *names)
      if (table.has(name)) observation.columns[name] = table.numbers(name);
  if (table.rows() < form.least_rows)
    bad_input("{}: found {} row(s), expected at least {} for {}", observation.file.string(), table.rows(),
              form.least_rows, form.name);
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
  static const std::vector<std::string> known = {"kind", "name", "file", "set", "beads"};
  const auto* table = place.node.as_table();
  if (!table) bad_input("{}: found {}, expected [[observation]]", place.str(), type_name(place.node));
  Observation observation;
  for (const char* needed : {"kind", "file"})
    if (!table->contains(needed)) bad_input("{}: {} is missing", place.str(), needed);
  for (const auto& [key, node] : *table) {
    const TomlPlace here{place.file, "observation." + std::string(key.str()), node};
    if (key == "kind")
      observation.kind = kind_at(here);
    else if (key == "name")
      observation.name = word_at(here);
    else if (key == "file")
      observation.file = file_at(here);
    else if (key == "beads")
      observation.beads = file_at(here);
    else if (key == "set")
      observation.set = settings_at(here);
    else
      bad_input("{}: unknown key, the nearest known one is \"observation.{}\"", here.str(),
                nearest_name(std::string(key.str()), known));
  }
  if (observation.name.empty()) observation.name = observation.file.stem().string();
  read_columns(observation);
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

}  // namespace

std::string to_string(Kind kind) {
  return form_of(kind).name;
}

Sample Experiment::sample_of(const Observation& observation) const {
  return changed_sample(sample, [&](Sample& changed) {
    for (const auto& [key, value] : observation.set)
      set_sample_key(changed, key, value, observation.name + ": " + key);
  });
}

Experiment read_experiment(const fs::path& path) {
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
  if (experiment.observations.empty()) bad_input("{}: found no [[observation]], expected at least one", file);
  if (experiment.name.empty()) experiment.name = path.stem().string();
  experiment.sample = read_sample(experiment.sample_file);
  for (auto& observation : experiment.observations) check_plausible(experiment, observation);
  std::set<fs::path> files;
  for (const auto& observation : experiment.observations)
    if (!observation.beads.empty()) files.insert(observation.beads);
  std::vector<std::vector<Bead>> tables;
  for (const auto& one : files) tables.push_back(read_beads(one));
  experiment.contacts = contact_peak(tables);
  return experiment;
}

}  // namespace pendular::diagnosis
