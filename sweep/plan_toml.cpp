#include <algorithm>
#include <set>

#include "base/nearest.h"
#include "base/toml_place.h"
#include "effects/list.h"
#include "sweep/plan.h"

namespace pendular::sweep {
namespace {

constexpr double kMostRuns = 100000;

using Entries = std::vector<std::pair<std::string, const toml::node*>>;

/// Keys and values of a table in the file's order. A table inside it is a dotted key without quotes.
Entries entries_of(const toml::table& table, const std::string& prefix = "") {
  Entries entries;
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const auto* inner = node.as_table()) {
      const Entries more = entries_of(*inner, name + ".");
      entries.insert(entries.end(), more.begin(), more.end());
    } else {
      entries.emplace_back(name, &node);
    }
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    const auto &first = a.second->source().begin, &second = b.second->source().begin;
    return std::pair(first.line, first.column) < std::pair(second.line, second.column);
  });
  return entries;
}

template <typename Integer>
Integer integer_at(const TomlPlace& place, std::int64_t lowest, std::int64_t highest) {
  const auto value = place.node.is_integer() ? place.node.value<std::int64_t>() : std::nullopt;
  if (!value || *value < lowest || *value > highest)
    bad_input("{}: found {}, expected an integer from {} to {}", place.str(),
              place.node.is_number() ? fmt::format("{}", number_at(place)) : type_name(place.node), lowest,
              highest);
  return static_cast<Integer>(*value);
}

bool choice_at(const TomlPlace& place, const std::string& no, const std::string& yes) {
  const std::string word = word_at(place);
  if (word != no && word != yes)
    bad_input("{}: found \"{}\", expected \"{}\" or \"{}\"", place.str(), word, no, yes);
  return word == yes;
}

/// What [sweep] says; whether it gives a seed for the packing.
bool read_head(SweepFile& sweep, const toml::table& table, const std::string& file) {
  static const std::vector<std::string> known = {"name",         "sample",   "packing",      "seed",
                                                 "realisations", "packings", "packing_seed", "keep"};
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max() - static_cast<int>(kMostRuns);
  bool packing_seed_given = false;
  for (const auto& [name, node] : entries_of(table)) {
    const TomlPlace place{file, "sweep." + name, *node};
    if (name == "name") {
      sweep.name = word_at(place);
    } else if (name == "sample") {
      sweep.sample = file_at(place);
    } else if (name == "packing") {
      sweep.packing = file_at(place);
    } else if (name == "seed") {
      sweep.seed = integer_at<std::uint64_t>(place, 0, kLargest);
    } else if (name == "realisations") {
      sweep.realisations = integer_at<int>(place, 1, static_cast<std::int64_t>(kMostRuns));
    } else if (name == "packings") {
      sweep.packing_each = choice_at(place, "one", "each");
    } else if (name == "packing_seed") {
      sweep.packing_seed = integer_at<std::uint64_t>(place, 0, kLargest);
      packing_seed_given = true;
    } else if (name == "keep") {
      sweep.keep_all = choice_at(place, "curve", "all");
    } else {
      bad_input("{}: unknown key, the nearest known one is \"sweep.{}\"", place.str(),
                nearest_name(name, known));
    }
  }
  return packing_seed_given;
}

/// Checks a key and one value for it by setting it in a sample that is thrown away.
void check_value(const TomlPlace& place, const SampleValue& value) {
  Sample sample;
  if (place.name == "W") {
    const auto* content = std::get_if<double>(&value);
    if (!content || !(*content > 0.0 && *content < 1.0))
      bad_input("{}: found {}, expected fractions between 0 and 1", place.str(), to_string(value));
    return;
  }
  auto names = sample_key_names();
  for (const auto& effect : effects::all_effects()) names.push_back("effects." + effect.id);
  if (std::find(names.begin(), names.end(), place.name) == names.end()) {
    names.push_back("W");
    bad_input("{}: unknown key, the nearest known one is \"{}\"", place.str(),
              nearest_name(place.name, names));
  }
  set_sample_key(sample, place.name, value, place.str());
  effects::check_effects(sample, place.str());
}

std::vector<SampleValue> values_at(const TomlPlace& place) {
  const auto* array = place.node.as_array();
  if (!array) bad_input("{}: found {}, expected an array of values", place.str(), type_name(place.node));
  if (array->empty()) bad_input("{}: found an empty array, expected at least one value", place.str());
  std::vector<SampleValue> values;
  for (const auto& item : *array) {
    const TomlPlace here{place.file, place.name, item};
    values.push_back(value_at(here));
    check_value(here, values.back());
  }
  return values;
}

/// Refuses a key that is varied twice.
void check_new(std::set<std::string>& varied, const TomlPlace& place) {
  if (!varied.insert(place.name).second)
    bad_input("{}: is varied twice, expected each key in one place", place.str());
}

void add_grid(SweepFile& sweep, const toml::node& node, std::set<std::string>& varied,
              const std::string& file) {
  if (!node.is_table() || node.as_table()->empty())
    bad_input("{}: found {}, expected a table of keys with their values", TomlPlace{file, "grid", node}.str(),
              node.is_table() ? "an empty grid" : type_name(node));
  for (const auto& [name, values] : entries_of(*node.as_table())) {
    const TomlPlace place{file, name, *values};
    check_new(varied, place);
    Axis& axis = sweep.axes.emplace_back();
    axis.keys = {name};
    for (auto& value : values_at(place)) axis.points.push_back({std::move(value)});
  }
}

void add_list(SweepFile& sweep, const toml::node& node, std::set<std::string>& varied,
              const std::string& file) {
  if (!node.is_table() || node.as_table()->empty())
    bad_input("{}: expected [[list]] with at least one key and its values",
              TomlPlace{file, "list", node}.str());
  Axis axis;
  for (const auto& [name, values] : entries_of(*node.as_table())) {
    const TomlPlace place{file, name, *values};
    check_new(varied, place);
    const auto given = values_at(place);
    if (axis.keys.empty()) axis.points.resize(given.size());
    if (given.size() != axis.points.size())
      bad_input("{}: found {} values, expected {} as {} has, because a list varies its keys together",
                place.str(), given.size(), axis.points.size(), axis.keys.front());
    axis.keys.push_back(name);
    for (std::size_t k = 0; k < given.size(); ++k) axis.points[k].push_back(given[k]);
  }
  sweep.axes.push_back(std::move(axis));
}

void check_together(const SweepFile& sweep, bool packing_seed_given, const std::string& file) {
  if (sweep.sample.empty()) bad_input("{}: sweep.sample is missing, expected a sample file", file);
  if (!sweep.packing.empty() && (sweep.packing_each || packing_seed_given))
    bad_input("{}: sweep.packing with {}: expected one of them, because a file's beads are used as they are",
              file, sweep.packing_each ? "packings = \"each\"" : "packing_seed");
  if (sweep.packing_each && packing_seed_given)
    bad_input("{}: packings = \"each\" with packing_seed: expected one of them", file);
  double runs = sweep.realisations;
  for (const auto& axis : sweep.axes) runs *= static_cast<double>(axis.points.size());
  if (runs > kMostRuns) bad_input("{}: found {} runs, expected at most {}", file, runs, kMostRuns);
}

}  // namespace

SweepFile read_sweep(const fs::path& path, const std::optional<std::uint64_t>& seed) {
  const std::string file = path.string();
  const toml::table root = parse_toml(read_text(path), file);
  SweepFile sweep;
  bool packing_seed_given = false;
  std::set<std::string> varied;
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (name == "sweep" && node.is_table()) {
      packing_seed_given = read_head(sweep, *node.as_table(), file);
    } else if (name == "grid") {
      add_grid(sweep, node, varied, file);
    } else if (name == "list" && node.is_array()) {
      for (const auto& item : *node.as_array()) add_list(sweep, item, varied, file);
    } else {
      bad_input("{}: unknown section, expected [sweep], [grid] or [[list]]",
                TomlPlace{file, name, node}.str());
    }
  }
  if (seed) sweep.seed = *seed;
  if (!packing_seed_given) sweep.packing_seed = sweep.seed;
  check_together(sweep, packing_seed_given, file);
  return sweep;
}

}  // namespace pendular::sweep
