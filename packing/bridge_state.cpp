#include <array>
#include <utility>

#include "base/error.h"
#include "packing/packing.h"

namespace pendular {
namespace {

constexpr std::array<std::pair<BridgeState, const char*>, 4> kWords = {{
    {BridgeState::candidate, "candidate"},
    {BridgeState::bridge, "bridge"},
    {BridgeState::none, "none"},
    {BridgeState::undetermined, "undetermined"},
}};

}  // namespace

std::string to_string(BridgeState state) {
  for (const auto& [value, word] : kWords)
    if (value == state) return word;
  throw std::logic_error("to_string: no such bridge state");
}

BridgeState bridge_state(const std::string& word) {
  for (const auto& [value, known] : kWords)
    if (word == known) return value;
  bad_input("found \"{}\", expected bridge, none, undetermined or candidate", word);
}

}  // namespace pendular
