#include "blind/split.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/model_version.h"
#include "base/nearest.h"
#include "base/toml_place.h"
#include "blind/engine.h"
#include "diagnosis/experiment/believed.h"
#include "effects/list.h"

namespace pendular::blind {
namespace {

const std::vector<std::string>& stratum_names() {
  static const std::vector<std::string> names = {"library",      "none",      "outside",     "pair",
                                                 "wrong_belief", "other_law", "other_engine"};
  return names;
}

const std::vector<std::string>& observed_names() {
  static const std::vector<std::string> names = {"curve", "network", "second_specimen", "scan"};
  return names;
}

/// The place of a word among those that are known.
std::size_t place_among(const std::vector<std::string>& names, const std::string& word, const char* what,
                        const std::string& where) {
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end())
    bad_input("{}: unknown {} \"{}\", the nearest known one is \"{}\"", where, what, word,
              nearest_name(word, names));
  return static_cast<std::size_t>(found - names.begin());
}

// Shares that leave each stratum of eighty cases some eight to thirty of them.
constexpr std::array<double, kStrata> kDefaultShares = {0.35, 0.12, 0.20, 0.12, 0.12, 0.09, 0.0};
constexpr std::array<double, kObserved> kDefaultObserved = {0.15, 0.20, 0.25, 0.40};

/// Without `engines`: the cases of a split follow from it, so that engines that come later are no part of it.
std::vector<std::string> default_engines() {
  return {"yade", "yade_limits", "yade_hertz", "one_spring", "coulomb_bonds", "damped"};
}

const toml::table& table_at(const TomlPlace& place) {
  if (!place.node.is_table()) bad_input("{}: found {}, expected a table", place.str(), type_name(place.node));
  return *place.node.as_table();
}

double number_between(const TomlPlace& place, double lowest, double highest) {
  const double value = number_at(place);
  if (value < lowest || value > highest)
    bad_input("{}: found {}, expected {} to {}", place.str(), value, lowest, highest);
  return value;
}

std::uint64_t whole_at(const TomlPlace& place) {
  const auto value = place.node.value_exact<std::int64_t>();
  if (!value || *value < 0) bad_input("{}: expected a whole number, not negative", place.str());
  return static_cast<std::uint64_t>(*value);
}

[[noreturn]] void unknown_key(const TomlPlace& place, const std::vector<std::string>& known) {
  bad_input("{}: unknown key, the nearest known one is \"{}\"", place.str(), nearest_name(place.name, known));
}

/// Calls take(key, place) for each key of a section; false means that the key is unknown.
template <typename Take>
void read_section(const TomlPlace& section, const std::vector<std::string>& known, const Take& take) {
  for (const auto& [key, node] : table_at(section)) {
    const TomlPlace place{section.file, std::string(key.str()), node};
    if (std::find(known.begin(), known.end(), place.name) == known.end()) unknown_key(place, known);
    take(place.name, place);
  }
}

std::vector<std::string> engines_at(const TomlPlace& place) {
  const auto* array = place.node.as_array();
  if (!array) bad_input("{}: found {}, expected a list of engines", place.str(), type_name(place.node));
  std::vector<std::string> names;
  for (const auto& node : *array)
    names.push_back(find_engine(word_at({place.file, place.name, node}), place.str()).name);
  if (names.empty()) bad_input("{}: found none, expected at least one engine", place.str());
  return names;
}

void read_head(Split& split, fs::path& sample, const TomlPlace& section) {
  const std::vector<std::string> known = {"name", "seed", "cases", "sample", "engines"};
  read_section(section, known, [&](const std::string& key, const auto& place) {
    if (key == "name")
      split.name = word_at(place);
    else if (key == "engines")
      split.engines = engines_at(place);
    else if (key == "seed")
      split.seed = whole_at(place);
    else if (key == "cases")
      split.cases = whole_at(place);
    else
      sample = file_at(place);
  });
}

void read_test(Split& split, const TomlPlace& section) {
  read_section(section, {"max_strain", "unload_at", "sigma_centre_um", "sigma_diameter_um"},
               [&](const std::string& key, const auto& place) {
                 if (key == "max_strain")
                   split.max_strain = number_between(place, 0.005, 0.3);
                 else if (key == "unload_at")
                   split.unload_at = number_between(place, 0.002, 0.3);
                 else
                   (key == "sigma_centre_um" ? split.sigma_centre : split.sigma_diameter) =
                       1e-6 * number_between(place, 0.0, 100.0);
               });
}

void read_uncertainty(Split& split, const TomlPlace& section) {
  std::vector<std::string> known;
  for (const auto& key : sample_keys()) known.push_back(key.name);
  read_section(section, known, [&](const std::string& key, const auto& place) {
    split.uncertainty[key] = number_between(place, 0.0, 1e12);
  });
}

/// Shares by name, made to sum to 1; those that are not named are 0.
template <std::size_t size>
void read_shares(std::array<double, size>& shares, const std::vector<std::string>& names,
                 const TomlPlace& section) {
  shares = {};
  read_section(section, names, [&](const std::string& key, const auto& place) {
    const auto at = std::find(names.begin(), names.end(), key) - names.begin();
    shares[static_cast<std::size_t>(at)] = number_between(place, 0.0, 1e6);
  });
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (sum <= 0.0) bad_input("{}: found no share above 0", section.str());
  for (double& share : shares) share /= sum;
}

void read_seen_from(Split& split, const TomlPlace& section) {
  std::vector<std::string> known;
  for (const auto& effect : effects::all_effects()) known.push_back(effect.id);
  read_section(section, known, [&](const std::string& key, const auto& place) {
    const auto& effect = effects::find_effect(key, place.str());
    const double most = std::max(std::fabs(effect.bank_from), std::fabs(effect.bank_to));
    split.seen_from[key] = number_between(place, 0.0, most);
  });
}

SharedPacking packing_at(const TomlPlace& section) {
  SharedPacking packing;
  const std::vector<std::string> known = {"seed", "height_um", "short_height_um", "short_youngs_modulus_pa",
                                          "scan_strain"};
  for (const auto& key : known)
    if (key != "scan_strain" && !table_at(section).contains(key))
      bad_input("{}: {} is missing", section.str(), key);
  read_section(section, known, [&](const std::string& key, const auto& place) {
    if (key == "seed")
      packing.seed = whole_at(place);
    else if (key == "short_youngs_modulus_pa")
      packing.short_youngs_modulus = number_between(place, 1.0, 1e12);
    else if (key == "scan_strain")
      packing.scan_strain = number_between(place, 1e-3, 0.1);
    else
      (key == "height_um" ? packing.height : packing.short_height) = 1e-6 * number_between(place, 1.0, 1e6);
  });
  return packing;
}

void read_packings(Split& split, const TomlPlace& place) {
  const auto* array = place.node.as_array();
  if (!array) bad_input("{}: found {}, expected [[packing]]", place.str(), type_name(place.node));
  for (const auto& node : *array) split.packings.push_back(packing_at({place.file, "packing", node}));
}

void check(const Split& split) {
  const std::string file = split.file.string();
  if (split.name.empty()) bad_input("{}: split.name is missing", file);
  if (split.cases == 0) bad_input("{}: split.cases: found none, expected at least one", file);
  if (split.packings.empty()) bad_input("{}: found no [[packing]], expected at least one", file);
  if (split.unload_at >= split.max_strain)
    bad_input("{}: test.unload_at: found {}, expected less than max_strain {}", file, split.unload_at,
              split.max_strain);
  if (split.sample.beads.diameters != Diameters::measured)
    bad_input("{}: its sample has beads.diameters = \"{}\", expected \"measured\"", file,
              to_string(split.sample.beads.diameters));
  if (split.sample.compression.control != Control::speed)
    bad_input("{}: its sample has compression.control = \"{}\", expected \"speed\"", file,
              to_string(split.sample.compression.control));
  if (!split.sample.effects.empty()) bad_input("{}: its sample has [effects], expected none", file);
}

}  // namespace

std::string to_string(Stratum stratum) {
  return stratum_names()[static_cast<std::size_t>(stratum)];
}

Stratum stratum_of(const std::string& word, const std::string& where) {
  return static_cast<Stratum>(place_among(stratum_names(), word, "stratum", where));
}

std::string to_string(Observed observed) {
  return observed_names()[static_cast<std::size_t>(observed)];
}

Observed observed_of(const std::string& word, const std::string& where) {
  return static_cast<Observed>(place_among(observed_names(), word, "set of observations", where));
}

Split read_split(const fs::path& path, std::optional<std::uint64_t> seed) {
  Split split;
  split.file = path;
  split.shares = kDefaultShares;
  split.observed = kDefaultObserved;
  split.engines = default_engines();
  const std::string file = path.string(), text = read_text(path);
  fs::path sample;
  const toml::table root = parse_toml(text, file);
  for (const auto& [key, node] : root) {
    const TomlPlace place{file, std::string(key.str()), node};
    if (key == "split")
      read_head(split, sample, place);
    else if (key == "test")
      read_test(split, place);
    else if (key == "uncertainty")
      read_uncertainty(split, place);
    else if (key == "strata")
      read_shares(split.shares, stratum_names(), place);
    else if (key == "observed")
      read_shares(split.observed, observed_names(), place);
    else if (key == "seen_from")
      read_seen_from(split, place);
    else if (key == "packing")
      read_packings(split, place);
    else
      unknown_key(place, {"split", "test", "uncertainty", "strata", "observed", "seen_from", "packing"});
  }
  if (sample.empty()) bad_input("{}: split.sample is missing, expected a sample file", file);
  split.sample = read_sample(sample);
  if (seed) split.seed = *seed;
  check(split);
  split.content =
      sha256(fmt::format("{}\n{}\n{}\n{}", kModelVersion, split.seed, text, sample_text(split.sample)));
  return split;
}

Sample believed_a(const Split& split, const SharedPacking& packing) {
  Sample sample = split.sample;
  sample.specimen.height = packing.height;
  return sample;
}

Sample believed_b(const Split& split, const SharedPacking& packing) {
  return diagnosis::changed_sample(believed_a(split, packing), [&](Sample& changed) {
    changed.specimen.height = packing.short_height;
    changed.bridges.youngs_modulus = packing.short_youngs_modulus;
  });
}

}  // namespace pendular::blind
