#include "diagnosis/words.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/quantity.h"
#include "diagnosis/inference/evidence.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

/// What `of_one` makes of the effects that an id holds.
template <typename OfOne>
std::string of_each(const std::string& id, const char* between, const OfOne& of_one) {
  std::string text;
  for (const auto& effect : effects_in(id)) {
    if (!text.empty()) text += between;
    text += of_one(effect);
  }
  return text;
}

}  // namespace

std::string plain_name(const std::string& id) {
  if (id == "none") return "no effect";
  if (id == "unknown") return "something not in the library";
  if (id == kOtherPairs) return "two effects that no run has together";
  return of_each(id, " with ", [](const std::string& one) {
    const auto* effect = effects::known_effect(one);
    return effect ? effect->name : one;
  });
}

std::string sentence_of(const std::string& id) {
  if (id == "none") return "Experiment and simulation as believed agree within the noise.";
  if (id == "unknown")
    return "Something acts that is none of the known effects, or a believed input is farther off.";
  if (id == kOtherPairs) return "Two known effects act at once, in a pair that no run has.";
  return of_each(id, " ", [](const std::string& one) {
    const auto* effect = effects::known_effect(one);
    return effect ? effect->sentence : std::string();
  });
}

std::string name_and_id(const std::string& id) {
  const std::string name = plain_name(id);
  return name == id ? id : fmt::format("{} ({})", name, id);
}

std::string magnitudes_in_words(const Explanation& explanation) {
  std::string text;
  for (std::size_t k = 0; k < explanation.magnitudes.size(); ++k) {
    const Magnitude& m = explanation.magnitudes[k];
    const std::string unit = k < explanation.units.size() ? explanation.units[k] : "";
    if (k > 0) text += " and ";
    text += quantity(m.mean, m.interval_90, unit);
  }
  return text;
}

std::string in_words(const Explanation& explanation) {
  const std::string name = name_and_id(explanation.id), magnitudes = magnitudes_in_words(explanation);
  return magnitudes.empty() ? name : name + ", " + magnitudes;
}

std::string name_in_words(std::string feature) {
  for (const std::string unit : {"_um", "_um2"})
    if (feature.ends_with(unit)) feature.resize(feature.size() - unit.size());
  std::replace(feature.begin(), feature.end(), '_', ' ');
  return feature;
}

std::string in_words(const Feature& feature) {
  if (feature.name == feature.observation) return feature.name;
  return fmt::format("{} of {}", name_in_words(feature.name), feature.observation);
}

std::string unit_of(const Feature& feature) {
  const auto has = [&](const char* part) { return feature.name.find(part) != std::string::npos; };
  if (feature.name.ends_with("_um")) return "um";
  if (feature.name.ends_with("_um2")) return "um2";
  if (has("exponent")) return "1";
  if (feature.name == "kn_level" || feature.name == "kt_level") return "N/m";
  if (has("modulus") || has("stress")) return "Pa";
  if (has("strain") || feature.name == "linear_limit" || feature.name.starts_with("bridged_"))
    return "fraction";
  return "1";
}

std::string unit_of_key(const std::string& key) {
  return key.ends_with("_pa") ? "Pa" : key.ends_with("_um") ? "um" : "1";
}

std::string limit_in_words(double limit, const std::string& unit) {
  return quantity_within(limit, 0.1 * limit, unit);
}

std::string in_words(const Shrinkage& shrinkage) {
  if (shrinkage.nothing_to_close) return "nothing to close";
  return quantity(shrinkage.fraction, shrinkage.interval_90, "fraction");
}

std::string outlook_in_words(const Outlook& with, const Outlook& without) {
  const std::string left = fmt::format("{:.1f}", with.set_size),
                    now = fmt::format("{:.1f}", without.set_size);
  if (with.set_size < without.set_size && left != now)
    return fmt::format("leave {} explanations of {}", left, now);
  if (with.settled > without.settled && percent(with.settled) != percent(without.settled))
    return fmt::format("leave one explanation in {} of such experiments instead of {}", percent(with.settled),
                       percent(without.settled));
  return "make the right explanation more probable";
}

std::string joined(const std::vector<std::string>& words, std::size_t most, const char* last) {
  std::vector<std::string> shown(words.begin(), words.begin() + std::min(words.size(), most));
  if (words.size() > most) shown.push_back(fmt::format("{} more", words.size() - most));
  std::string text;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (k > 0) text += k + 1 == shown.size() ? last : ", ";
    text += shown[k];
  }
  return text;
}

}  // namespace pendular::diagnosis
