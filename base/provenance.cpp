#include "base/provenance.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pendular {

void Provenance::add_input(const fs::path& path) {
  inputs.push_back({path.string(), sha256_of(path)});
}

std::string program_version() {
  return PENDULAR_VERSION;
}

nlohmann::ordered_json to_json(const Provenance& provenance) {
  nlohmann::ordered_json inputs = nlohmann::ordered_json::array();
  for (const auto& input : provenance.inputs)
    inputs.push_back({{"path", input.path}, {"sha256", input.sha256}});
  return {{"program", "pendular"},
          {"version", provenance.version},
          {"command", provenance.command},
          {"seed", provenance.seed},
          {"inputs", inputs}};
}

Provenance provenance_from_json(const nlohmann::json& json) {
  Provenance provenance;
  provenance.version = json.value("version", "");
  provenance.command = json.value("command", "");
  provenance.seed = json.value("seed", std::uint64_t{0});
  for (const auto& input : json.value("inputs", nlohmann::json::array()))
    provenance.inputs.push_back({input.value("path", ""), input.value("sha256", "")});
  return provenance;
}

std::string to_comment(const Provenance& provenance) {
  std::string text;
  const auto add = [&text](std::string line) {
    // Of a path or an argument: the comment would end there.
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += "# " + line + '\n';
  };
  add("pendular " + provenance.version);
  add("command: " + provenance.command);
  add(fmt::format("seed: {}", provenance.seed));
  for (const auto& input : provenance.inputs) add("input: " + input.path + " sha256 " + input.sha256);
  return text;
}

}  // namespace pendular
