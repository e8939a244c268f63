#include "diagnosis/bank/law_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace pendular::diagnosis {
namespace {

template <class Is>
const LawReading* first_with(Is is) {
  const auto& all = law_readings();
  const auto found = std::find_if(all.begin(), all.end(), is);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

const std::vector<LawReading>& law_readings() {
  static const std::vector<LawReading> all = {
      {"tangential_springs", "one tangential spring or two",
       [](Sample& sample) {
         auto& springs = sample.contact.tangential_springs;
         springs = springs == TangentialSprings::one ? TangentialSprings::two : TangentialSprings::one;
       }},
      {"bond_friction_limit", "Coulomb's limit on bonds",
       [](Sample& sample) { sample.contact.bond_friction_limit = !sample.contact.bond_friction_limit; }},
      {"breaking", "one criterion of breaking or two limits",
       [](Sample& sample) {
         auto& breaking = sample.bridges.breaking;
         breaking = breaking == Breaking::griffith ? Breaking::limits : Breaking::griffith;
       }},
      {"glass", "linear glass or Hertz's",
       [](Sample& sample) {
         auto& glass = sample.contact.glass;
         glass = glass == Glass::linear ? Glass::hertz : Glass::linear;
       }},
  };
  return all;
}

std::string other_setting(const LawReading& reading, const Sample& sample) {
  Sample changed = sample;
  reading.other(changed);
  const auto before = sample_settings(sample), after = sample_settings(changed);
  const auto differs = std::mismatch(before.begin(), before.end(), after.begin()).second;
  if (differs == after.end()) return reading.name;
  if (const bool* flag = std::get_if<bool>(&differs->second))
    return fmt::format("{} = {}", differs->first, *flag);
  return fmt::format("{} = \"{}\"", differs->first, std::get<std::string>(differs->second));
}

const LawReading* find_law_reading(const std::string& id) {
  return first_with([&](const LawReading& one) { return id == one.id; });
}

const LawReading* law_reading_named(const std::string& name) {
  return first_with([&](const LawReading& one) { return name == one.name; });
}

}  // namespace pendular::diagnosis
